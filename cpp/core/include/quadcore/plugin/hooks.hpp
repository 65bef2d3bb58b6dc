#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "quadcore/plugin/carried_body.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/plugin/loads.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/other_vehicle.hpp"
#include "quadcore/plugin/tags.hpp"
#include "quadcore/plugin/topics.hpp"
#include "quadcore/plugin/vehicle_description.hpp"
#include "quadcore/plugin/world.hpp"
#include "quadcore/plugin_interface.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Force laws that quadcore's own plugins pass to engines; defined in force_laws.hpp, which is not
/// for other plugins.
struct ForceLaws;

/// A plugin's state: plain numbers owned by the simulation, so that snapshot, restore and reset are
/// exact. All are zero at the start.
using PluginState = Eigen::Map<VectorXd>;
/// Read-only plugin state.
using ConstPluginState = Eigen::Map<const VectorXd>;

/// Data that a plugin receives at a sampling instant.
struct Sample {
  double time;                         ///< s
  double dt;                           ///< time step [s]
  const Kinematics& kinematics;        ///< motion at `time`
  const World& world;                  ///< world of the flight
  Topics& topics;                      ///< topics to read and to publish
  std::vector<std::string>& warnings;  ///< warnings for the user; give each only once per flight
  std::uint64_t seed =
      0;  ///< seed of the plugin's random numbers, from the simulation's seed and its name
  bool jumped = false;  ///< the state was set, so sensors must publish at once
};

/// A loaded plugin. It is immutable once created: all values that change during a flight are in the
/// PluginState that each hook receives. Hooks may throw FlightError to end the flight. Hooks with a
/// ConstPluginState are pure functions.
class Plugin {
 public:
  virtual ~Plugin() = default;

  /// Return the number of state values that this plugin needs.
  virtual std::size_t state_size() const { return 0; }
  /// Describe how the rotors that this plugin drives follow a command, and slowdown factor and
  /// radius of rotors on which it exerts forces.
  virtual void describe_rotors(std::vector<RotorDescription>&) const {}
  /// Called once when all plugins have been created. A plugin must not change afterwards.
  virtual void prepare(const VehicleDescription&) {}
  /// Called at the start of each step of a fleet, before update(): the other vehicles as they are
  /// at this time, so that the order of the vehicles has no effect. Never called for a vehicle that
  /// is alone in its world.
  virtual void observe(const Sample&, const OtherVehicles&, PluginState) const {}
  /// Called at the start of each step: commands and sampled controllers.
  virtual void update(const Sample&, PluginState) const {}
  /// Called at time 0, after a state was set, and at the end of each step: sensors.
  virtual void sense(const Sample&, PluginState) const {}
  /// Add the plugin's forces. Called as often as the engine's integrator requires.
  virtual void forces(const Kinematics&, ConstPluginState, Loads&) const {}
  /// For quadcore's own plugins only. Provide all force laws that make up forces(); called once
  /// when all plugins have been created. An engine may evaluate the laws itself for several rotors
  /// at once instead of calling forces(). The tables they point to belong to the plugin or its
  /// state. The class must have a member law_interface with the value of
  /// quadcore/law_interface.hpp.
  virtual void laws(ConstPluginState, ForceLaws&) const {}
  /// Add to the velocity of the air at the frame's origin, in world axes [m/s]. Called before all
  /// force laws; the air velocity in the motion is still zero.
  virtual void air(const Kinematics&, ConstPluginState, Vector3d& /*v_WA_W*/) const {}
  /// Add the bodies attached to the frame. Called once per step after all updates. If the bodies
  /// change, the vehicle continues with the new mass and the same motion of the frame.
  virtual void carried(ConstPluginState, std::vector<CarriedBody>&) const {}
};

/// The hooks that a plugin class overrides; the others are never called. For an unknown class, all
/// hooks except laws(), which would replace forces(), count as overridden.
struct Hooks {
  /// \cond
  bool prepare = true, observe = true, update = true, sense = true, forces = true, air = true,
       carried = true;
  /// \endcond
  const char* laws = nullptr;  ///< law_interface of a class with laws()

  /// Return the hooks that class P, derived from Plugin, overrides.
  template <class P>
  static constexpr Hooks of() {
    return {!std::is_same_v<decltype(&P::prepare), decltype(&Plugin::prepare)>,
            !std::is_same_v<decltype(&P::observe), decltype(&Plugin::observe)>,
            !std::is_same_v<decltype(&P::update), decltype(&Plugin::update)>,
            !std::is_same_v<decltype(&P::sense), decltype(&Plugin::sense)>,
            !std::is_same_v<decltype(&P::forces), decltype(&Plugin::forces)>,
            !std::is_same_v<decltype(&P::air), decltype(&Plugin::air)>,
            !std::is_same_v<decltype(&P::carried), decltype(&Plugin::carried)>,
            law_interface_of<P>()};
  }

 private:
  template <class P>
  static constexpr const char* law_interface_of() {
    if constexpr (std::is_same_v<decltype(&P::laws), decltype(&Plugin::laws)>) {
      return nullptr;
    } else {
      return P::law_interface;
    }
  }
};

/// Arguments of a plugin's constructor.
struct PluginSetup {
  const std::string& name;             ///< name attribute of the plugin tag
  const Parameters& parameters;        ///< effective parameters
  const Model& model;                  ///< model of the vehicle
  const World& world;                  ///< world of the flight
  Topics& topics;                      ///< for declaring topics
  std::vector<std::string>& warnings;  ///< warnings about valid but suspicious input
  /// Maximum decay rate of a force law that the engine integrates stably with this time step [1/s].
  double fastest_decay;
  double dt;  ///< time step [s]
  /// Whether the engine supports rotors that turn by more than half a turn per step.
  bool follows_any_turn;
};

/// Factory for plugins of one class.
struct PluginMaker {
  std::unique_ptr<Plugin> (*make)(const PluginSetup&) = nullptr;  ///< null: no class
  Hooks hooks = {};  ///< hooks that the class overrides

  /// Return whether the factory has a class.
  explicit operator bool() const { return make; }
};

/// Factory of a class with a constructor that takes a PluginSetup.
template <class P>
constexpr PluginMaker create{
    [](const PluginSetup& setup) -> std::unique_ptr<Plugin> { return std::make_unique<P>(setup); },
    Hooks::of<P>()};

/// Description of a plugin module.
struct PluginDescriptor {
  std::string summary;                ///< one line
  std::vector<TagSpec> tags;          ///< all parameters
  std::vector<std::string> wrenches;  ///< names of the wrench terms that forces() reports
  PluginMaker create;                 ///< create<P> for the plugin class P
  bool adds_up = false;  ///< allows several instances and sums their wrenches of the same name
};

/// Entry point of a plugin library. It is read first, so its layout must never change.
struct PluginModule {
  const char* interface;                    ///< plugin_interface at the library's build
  const PluginDescriptor* (*descriptor)();  ///< result is valid until the process ends
};

}  // namespace quadcore

/// Symbol name of a library's PluginModule, which is always exported. Plugins linked into one
/// binary have individual names, which a static core does not export.
#ifdef QUADCORE_PLUGIN_SYMBOL
#define QUADCORE_PLUGIN_EXPORT QUADCORE_EXPORT
#else
#define QUADCORE_PLUGIN_SYMBOL quadcore_plugin
/// Exports the symbol from the library.
#define QUADCORE_PLUGIN_EXPORT __attribute__((visibility("default")))
#endif

/// Turns a shared library into a quadcore plugin. `describe` is a function that returns its
/// PluginDescriptor. Use it once per library, outside any namespace.
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
