#pragma once

#include <string>
#include <vector>

#include "quadcore/export.hpp"

namespace quadcore QUADCORE_EXPORT {

struct LoadedPlugin;
struct Model;
struct World;
class Topics;

/// Something that a flight depends on, and its value: numbers, or a text.
struct Fact {
  std::string what;
  std::vector<double> numbers;
  std::string text;

  bool operator==(const Fact& other) const {
    return what == other.what && numbers == other.numbers && text == other.text;
  }
};
using Facts = std::vector<Fact>;

/// What the future of a flight depends on besides its snapshot, part by part. It holds no path, so
/// that the same simulation elsewhere has the same, and what differs can be told.
struct Fingerprint {
  Facts engine;
  Facts step;        ///< [s]
  Facts model;       ///< links and joints, without plugins
  Facts plugins;     ///< names, modules, sizes of state, topics
  Facts world;       ///< as it is felt
  Facts parameters;  ///< every effective one, as PLUGIN.TAG

  Fingerprint() = default;
  Fingerprint(const std::string& engine, double dt, const Model& model, const World& world,
              const std::vector<LoadedPlugin>& plugins, const Topics& topics);
};

/// Parts of a fingerprint that may differ on purpose. With another engine, step, model or set of
/// plugins a snapshot would mean nothing.
struct Allowed {
  bool world = false;
  bool parameters = false;

  /// Throws InputError on a name that is none of these members'.
  static Allowed of(const std::vector<std::string>& names);
};

/// Throws InputError that says which parts differ, and in what first, unless they may.
void check_same(const Fingerprint& there, const Fingerprint& here, const Allowed& allowed);

/// A part of a fingerprint and its name.
struct FingerprintPart {
  const char* name;
  const char* what;  ///< as errors call it
  Facts Fingerprint::* facts;
  bool Allowed::* allowed;  ///< null if it must agree
};
/// All parts, in the order in which they are told.
const std::vector<FingerprintPart>& fingerprint_parts();

}  // namespace quadcore
