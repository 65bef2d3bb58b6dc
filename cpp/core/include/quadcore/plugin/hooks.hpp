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
#include "quadcore/plugin/tags.hpp"
#include "quadcore/plugin/topics.hpp"
#include "quadcore/plugin/vehicle_description.hpp"
#include "quadcore/plugin/world.hpp"
#include "quadcore/plugin_interface.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Laws that the plugins of quadcore hand to engines; force_laws.hpp has them, which is for these
/// plugins alone.
struct ForceLaws;

/// A plugin's state: plain numbers that belong to the simulation, so that snapshot, restore and
/// reset are exact. All zero at the start.
using PluginState = Eigen::Map<VectorXd>;
/// The same to read.
using ConstPluginState = Eigen::Map<const VectorXd>;

/// What a plugin sees at a sampling instant.
struct Sample {
  double time;                         ///< s
  double dt;                           ///< length of the step [s]
  const Kinematics& kinematics;        ///< motion at `time`
  const World& world;                  ///< in which it flies
  Topics& topics;                      ///< to read and to publish
  std::vector<std::string>& warnings;  ///< what the user must know, each once per flight
  std::uint64_t seed = 0;  ///< of the plugin's random numbers: the simulation's, and the name's
  bool jumped = false;     ///< the motion was set, not flown: sensors answer at once, due or not
};

/// A loaded plugin. It is immutable once created: whatever changes during a flight lives in the
/// PluginState that each hook is handed. Hooks may throw FlightError to end the flight. Those that
/// are handed a ConstPluginState are pure functions.
class Plugin {
 public:
  virtual ~Plugin() = default;

  /// Numbers of state this plugin needs.
  virtual std::size_t state_size() const { return 0; }
  /// For a plugin that drives rotors: says how they follow a command. For one that exerts forces on
  /// rotors that turn slower than the forces assume: says by which factor.
  virtual void describe_rotors(std::vector<RotorDescription>&) const {}
  /// Once, when all plugins are made: the last moment at which a plugin may change.
  virtual void prepare(const VehicleDescription&) {}
  /// Once per step, at its start: commands, sampled control laws.
  virtual void update(const Sample&, PluginState) const {}
  /// At time 0, after a state was set, and at the end of each step: sensors.
  virtual void sense(const Sample&, PluginState) const {}
  /// The force law, evaluated as often as the engine's integrator needs.
  virtual void forces(const Kinematics&, ConstPluginState, Loads&) const {}
  /// For the plugins of quadcore: hands out the laws that make up forces(), all of them, once when
  /// all plugins are made. An engine may evaluate them itself, several rotors at once, and not call
  /// forces(). Tables that they point to lie in the plugin or in this state. Such a class has a
  /// member law_interface, which is that of quadcore/law_interface.hpp.
  virtual void laws(ConstPluginState, ForceLaws&) const {}
  /// Adds to the velocity of the air at the frame's origin, in world axes [m/s], before any force
  /// law is asked. The velocity that the motion holds is zero still.
  virtual void air(const Kinematics&, ConstPluginState, Vector3d& /*v_WA_W*/) const {}
  /// Adds the bodies that ride on the frame, once per step after all updates. Where the answer
  /// changes, the vehicle goes on as one of another mass, its frame moving as it did.
  virtual void carried(ConstPluginState, std::vector<CarriedBody>&) const {}
};

/// Which hooks a class of plugins has of its own; the others are never called. Of a class that is
/// not known all may be, but laws(), which would stand for forces(). Members have the hooks' names.
struct Hooks {
  /// \cond
  bool prepare = true, update = true, sense = true, forces = true, air = true, carried = true;
  /// \endcond
  const char* laws = nullptr;  ///< law_interface of a class that has laws()

  /// Those that class P, which is derived from Plugin, overrides.
  template <class P>
  static constexpr Hooks of() {
    return {!std::is_same_v<decltype(&P::prepare), decltype(&Plugin::prepare)>,
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

/// What a plugin is made from.
struct PluginSetup {
  const std::string& name;             ///< name attribute of the plugin tag
  const Parameters& parameters;        ///< that the tag and its overrides give
  const Model& model;                  ///< that is to fly
  const World& world;                  ///< in which it is to fly
  Topics& topics;                      ///< declare topics here
  std::vector<std::string>& warnings;  ///< what is allowed but was perhaps not meant
  /// Rate at which the engine's step no longer makes an error decay but grow, where the force law
  /// makes it decay faster than this [1/s].
  double fastest_decay;
  double dt;  ///< length of the step [s]
  /// Whether the engine lets a rotor turn by more than half a turn in a step.
  bool follows_any_turn;
};

/// Makes plugins of one class.
struct PluginMaker {
  std::unique_ptr<Plugin> (*make)(const PluginSetup&) = nullptr;  ///< null: none
  Hooks hooks = {};                                               ///< that the class has

  /// Whether there is a class to make plugins of.
  explicit operator bool() const { return make; }
};

/// The maker of a class that a PluginSetup constructs.
template <class P>
constexpr PluginMaker create{
    [](const PluginSetup& setup) -> std::unique_ptr<Plugin> { return std::make_unique<P>(setup); },
    Hooks::of<P>()};

/// What a module says of itself.
struct PluginDescriptor {
  std::string summary;                ///< one line
  std::vector<TagSpec> tags;          ///< every parameter
  std::vector<std::string> wrenches;  ///< names of the wrench terms that forces() reports
  PluginMaker create;                 ///< create<P>, P being the class of the plugin
  bool adds_up = false;  ///< several of them may fly, whose wrenches of one name are summed
};

/// What a library holds: the first that is read of it, so it stays as it is for ever.
struct PluginModule {
  const char* interface;                    ///< plugin_interface, as the library was built with it
  const PluginDescriptor* (*descriptor)();  ///< valid as long as the process
};

}  // namespace quadcore

/// The name of a library's PluginModule, which is exported whatever else is hidden. Where several
/// are linked together each has a name of its own, and a static core exports none.
#ifdef QUADCORE_PLUGIN_SYMBOL
#define QUADCORE_PLUGIN_EXPORT QUADCORE_EXPORT
#else
#define QUADCORE_PLUGIN_SYMBOL quadcore_plugin
/// Exports that name from the library.
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
