#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "quadcore/error.hpp"
#include "quadcore/export.hpp"
#include "quadcore/kinematics.hpp"
#include "quadcore/loads.hpp"
#include "quadcore/model.hpp"
#include "quadcore/plugin_interface.hpp"
#include "quadcore/tags.hpp"
#include "quadcore/topics.hpp"

namespace quadcore QUADCORE_EXPORT {

/// A plugin's state: plain numbers that belong to the simulation, so that snapshot, restore and
/// reset are exact. All zero at the start.
using PluginState = Eigen::Map<VectorXd>;
using ConstPluginState = Eigen::Map<const VectorXd>;

/// What a plugin sees at a sampling instant.
struct Sample {
  double time;                   ///< s
  double dt;                     ///< length of the step [s]
  const Kinematics& kinematics;  ///< motion at `time`
  Topics& topics;
  std::vector<std::string>& warnings;  ///< what the user must know, each once per flight
  bool jumped = false;  ///< the motion was set, not flown: sensors answer at once, due or not
};

/// A loaded plugin. It is immutable once created: whatever changes during a flight lives in the
/// PluginState that each hook is handed. Hooks may throw FlightError to end the flight.
class Plugin {
 public:
  virtual ~Plugin() = default;

  /// Numbers of state this plugin needs.
  virtual std::size_t state_size() const { return 0; }
  /// Once per step, at its start: commands, sampled control laws.
  virtual void update(const Sample&, PluginState) const {}
  /// At time 0, after a state was set, and at the end of each step: sensors.
  virtual void sense(const Sample&, PluginState) const {}
  /// The force law: a pure function, evaluated as often as the engine's integrator needs.
  virtual void forces(const Kinematics&, ConstPluginState, Loads&) const {}
};

/// What a plugin is made from.
struct PluginSetup {
  const std::string& name;  ///< name attribute of the plugin tag
  const Parameters& parameters;
  const Model& model;
  Topics& topics;                      ///< declare topics here
  std::uint64_t seed;                  ///< the simulation's
  std::vector<std::string>& warnings;  ///< what is allowed but was perhaps not meant
  /// Rate at which the engine's step no longer makes an error decay but grow, where the force law
  /// makes it decay faster than this [1/s].
  double fastest_decay;
};

/// What a module says of itself.
struct PluginDescriptor {
  std::string summary;                ///< one line
  std::vector<TagSpec> tags;          ///< every parameter
  std::vector<std::string> wrenches;  ///< names of the wrench terms that forces() reports
  std::unique_ptr<Plugin> (*create)(const PluginSetup&);
};

/// What a library holds: the first that is read of it, so it stays as it is for ever.
struct PluginModule {
  const char* interface;  ///< plugin_interface, as the library was built with it
  const PluginDescriptor* (*descriptor)();
};

}  // namespace quadcore

/// The name of a library's PluginModule, which is exported whatever else is hidden. A static core,
/// which holds several, gives each a name of its own and exports none.
#ifdef QUADCORE_PLUGIN_SYMBOL
#define QUADCORE_PLUGIN_EXPORT
#else
#define QUADCORE_PLUGIN_SYMBOL quadcore_plugin
#define QUADCORE_PLUGIN_EXPORT __attribute__((visibility("default")))
#endif

/// Makes a shared library a quadcore plugin. `describe` is a function that returns its
/// PluginDescriptor. Use once per library, outside any namespace.
#define QUADCORE_REGISTER_PLUGIN(describe)                                                    \
  /* Not a lambda: what one holds in an extern initialiser is shared by the whole process. */ \
  static const quadcore::PluginDescriptor* quadcore_descriptor() {                            \
    static const quadcore::PluginDescriptor descriptor = describe();                          \
    return &descriptor;                                                                       \
  }                                                                                           \
  extern "C" {                                                                                \
  QUADCORE_PLUGIN_EXPORT extern const quadcore::PluginModule QUADCORE_PLUGIN_SYMBOL;          \
  const quadcore::PluginModule QUADCORE_PLUGIN_SYMBOL = {quadcore::plugin_interface,          \
                                                         quadcore_descriptor};                \
  }
