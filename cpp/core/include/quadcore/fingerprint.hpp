#pragma once

#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

struct LoadedPlugin;
struct Model;
struct World;
class Topics;

/// Something that a flight depends on, and its value: numbers, or a text.
struct Fact {
  std::string what;             ///< what it is, for errors; "" of the only one of its part
  std::vector<double> numbers;  ///< SI units; none where the text says all
  std::string text;             ///< "" where numbers say all

  bool operator==(const Fact& other) const {
    return what == other.what && numbers == other.numbers && text == other.text;
  }
};
/// Those of one part, in an order that is the same wherever they are taken.
using Facts = std::vector<Fact>;

/// What the future of a flight depends on besides its snapshot, part by part. It holds no path, so
/// that the same simulation elsewhere has the same, and what differs can be told.
struct Fingerprint {
  Facts engine;      ///< its name
  Facts step;        ///< [s]
  Facts model;       ///< links and joints, without plugins
  Facts plugins;     ///< names, modules, sizes of state, topics
  Facts world;       ///< as it is felt
  Facts parameters;  ///< every effective one, as PLUGIN.TAG

  Fingerprint() = default;
  /// Of a simulation that is made of these, with steps of dt [s].
  Fingerprint(const std::string& engine, double dt, const Model& model, const World& world,
              const std::vector<LoadedPlugin>& plugins, const Topics& topics);
};

/// Parts of a fingerprint that may differ on purpose. With another engine, step, model or set of
/// plugins a snapshot would mean nothing.
struct Allowed {
  bool world = false;       ///< see Fingerprint::world
  bool parameters = false;  ///< see Fingerprint::parameters

  /// Throws InputError on a name that is none of these members'.
  static Allowed of(const std::vector<std::string>& names);
};

/// Throws InputError that says which parts differ, and in what first, unless they may.
void check_same(const Fingerprint& there, const Fingerprint& here, const Allowed& allowed);

/// A part of a fingerprint and its name.
struct FingerprintPart {
  const char* name;            ///< of the member of Fingerprint, as users write it
  const char* what;            ///< as errors call it
  Facts Fingerprint::* facts;  ///< the member
  bool Allowed::* allowed;     ///< null if it must agree
};
/// All parts, in the order in which they are told.
const std::vector<FingerprintPart>& fingerprint_parts();

}  // namespace quadcore
