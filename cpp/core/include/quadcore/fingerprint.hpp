#pragma once

#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

struct LoadedPlugin;
struct Model;
struct World;
class Topics;

/// A fact on which a flight depends, with its numbers or its text.
struct Fact {
  std::string what;             ///< name for errors; "" for the only fact of a part
  std::vector<double> numbers;  ///< values in SI units, if any
  std::string text;             ///< text, if any

  bool operator==(const Fact& other) const {
    return what == other.what && numbers == other.numbers && text == other.text;
  }
};
/// The facts of one part in a reproducible order.
using Facts = std::vector<Fact>;

/// Everything that a flight depends on in addition to its snapshot, in parts. It contains no paths,
/// so equal simulations on different machines have equal fingerprints, and differences can be
/// reported.
struct Fingerprint {
  Facts engine;      ///< name of the engine
  Facts step;        ///< time step [s]
  Facts model;       ///< links and joints, without plugins
  Facts plugins;     ///< names, modules, sizes of state, topics
  Facts world;       ///< settings that affect the motion
  Facts parameters;  ///< all effective parameters as PLUGIN.TAG

  Fingerprint() = default;
  /// Create the fingerprint of a simulation with these components and steps of dt [s].
  Fingerprint(const std::string& engine, double dt, const Model& model, const World& world,
              const std::vector<LoadedPlugin>& plugins, const Topics& topics);
};

/// Parts of a fingerprint that may differ on purpose. A snapshot is meaningless for another engine,
/// step, model or set of plugins.
struct Allowed {
  bool world = false;       ///< see Fingerprint::world
  bool parameters = false;  ///< see Fingerprint::parameters

  /// Create from the names of members. Throws InputError for an unknown name.
  static Allowed of(const std::vector<std::string>& names);
};

/// Throw InputError that lists the parts that differ without permission and their first difference.
void check_same(const Fingerprint& there, const Fingerprint& here, const Allowed& allowed);

/// A part of a fingerprint and its name.
struct FingerprintPart {
  const char* name;            ///< name for users
  const char* what;            ///< name in error messages
  Facts Fingerprint::* facts;  ///< member of Fingerprint
  bool Allowed::* allowed;     ///< member of Allowed; null if the part must agree
};
/// Return all parts in the order of error messages.
const std::vector<FingerprintPart>& fingerprint_parts();

}  // namespace quadcore
