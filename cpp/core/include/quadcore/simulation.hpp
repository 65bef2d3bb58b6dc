#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quadcore/engine.hpp"
#include "quadcore/fingerprint.hpp"
#include "quadcore/plugin.hpp"
#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/world.hpp"
#include "quadcore/state.hpp"

namespace quadcore QUADCORE_EXPORT {

/// A plugin tag of the model, loaded.
struct LoadedPlugin {
  std::string name;                    ///< PluginElement::name, made unique
  std::string filename;                ///< PluginElement::filename
  std::string path;                    ///< PluginLibrary::path
  const PluginDescriptor* descriptor;  ///< what its module says of itself
  Parameters parameters;               ///< effective ones
  std::unique_ptr<Plugin> plugin;      ///< no longer changed once the simulation is made
  Eigen::Index state_begin = 0;        ///< of its numbers in Snapshot::plugin_state
  Eigen::Index state_size = 0;         ///< how many they are
  std::size_t term_begin = 0;          ///< first of its wrench terms among all
  std::string who = {};                ///< for errors: FILE:LINE: plugin 'name'
  std::uint64_t seed = 0;              ///< of its random numbers
};

/// Everything that the future of a simulation depends on, as plain numbers and texts.
struct Snapshot {
  std::shared_ptr<const Fingerprint> taken_from;  ///< of the simulation
  double start_time = 0;                          ///< when the steps began [s]
  std::int64_t steps = 0;                         ///< since then
  std::uint64_t seed = 0;                         ///< of all random numbers
  std::vector<double> engine;                     ///< what Engine::save() told
  VectorXd plugin_state;                          ///< of all plugins, see LoadedPlugin::state_begin
  std::vector<Message> messages;                  ///< of each topic
  std::vector<std::string> warnings;              ///< of the flight
  std::string failure;                            ///< why the flight ended; "" while it goes on
};

/// How a simulation is made, beside its model and its world.
struct SimulationOptions {
  std::string engine = "gazebo11";  ///< one of engines()
  std::optional<double> dt = {};    ///< s, from 1e-9; the world's max_step_size if absent
  std::uint64_t seed = 0;           ///< of all random numbers
  /// "PLUGIN.TAG" -> value, wins over the URDF.
  std::map<std::string, std::string> parameters = {};
  Pose spawn = {};  ///< of the frame in the world, at the start
};

/// One vehicle in one world: plugins and an engine, stepped from outside.
class Simulation : private ForceField {
 public:
  /// Anything that turns faster [rad/s] counts as diverged.
  static constexpr double max_rate = 1e6;
  /// Of command().
  static constexpr const char* command_topic = "vel_cmd";

  /// Loads the plugins that the model names, and stands at the start of the flight.
  /// Throws InputError, with FILE:LINE where a document is at fault.
  Simulation(Model model, const World& world, const SimulationOptions& options);

  /// Publishes rotor speeds [rad/s], signed, on topic `vel_cmd`.
  /// Throws InputError, nothing changed, on a wrong count, a number that is not finite, or if a
  /// plugin writes the topic.
  void command(const double* speeds, std::size_t count);
  /// Publishes a message on a topic that no plugin writes, for those that take it.
  /// Throws InputError, nothing changed, on a topic that is not declared or that a plugin writes, a
  /// wrong count, or a number that is not finite.
  void publish(const std::string& topic, const double* values, std::size_t count);
  /// Moves the vehicle over a step of dt [s] from the state it stands in to that at the end of the
  /// step, under the command of so many speeds [rad/s] that was published last; zero before.
  using Motion = std::function<void(double dt, const VectorXd& command, VehicleState& state)>;
  /// Takes the place of the engine's steps: plugins hear and sense as ever, but none of their
  /// forces acts, and nothing touches.
  void move_by(Motion motion);
  /// Advances by n steps. Throws FlightError if the flight fails; then only restore, reset and
  /// set_state make the simulation usable again.
  void step(std::int64_t n = 1);
  /// Whether command() reaches a plugin.
  bool takes_commands() const;
  /// Numbers that a command carries. Throws InputError if no plugin listens.
  std::size_t command_width() const;

  /// Of the state, s.
  double time() const { return start_time_ + static_cast<double>(steps_) * dt_; }
  /// Length of a step, s.
  double dt() const { return dt_; }
  /// One of engines().
  const std::string& engine_name() const { return engine_name_; }
  /// How the engine takes its steps, in one line for a person.
  std::string method() const { return engine_->method(); }
  /// As the engine flies it, with what rides on its frame now.
  const Model& model() const { return engine_->model(); }
  /// Rotor joints.
  std::size_t rotor_count() const { return model_.joints.size(); }
  /// Of the rotor joints, in the order of all that is said of rotors.
  std::vector<std::string> rotor_names() const { return model_.joint_names(); }
  /// As it was given.
  const World& world() const { return world_; }
  /// Of all that a flight depends on beside its state.
  const Fingerprint& fingerprint() const { return *fingerprint_; }
  /// As it stands now; the next step changes it.
  const VehicleState& state() const { return state_; }
  /// What plugins and callers have published.
  const Topics& topics() const { return topics_; }
  /// In the order of the URDF.
  const std::vector<LoadedPlugin>& plugins() const { return plugins_; }
  /// Whether odometry has its linear velocity along the axes of the frame; plugins that have the
  /// tag `twistFrame` agree on it.
  bool has_velocity_in_body() const;
  /// What was perhaps not meant: first what the model and its plugins said as they were loaded,
  /// then, growing as it happens, what plugins said of this flight. The latter are part of a
  /// snapshot; a reset leaves the former.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// Names that the user gave of what model and world hold and this simulation left out.
  const std::vector<std::string>& ignored() const { return ignored_; }

  /// Throws InputError on a state that is not finite or whose sizes differ.
  void set_state(const VehicleState& state);
  /// Everything that the future depends on.
  Snapshot snapshot() const;
  /// Throws InputError, nothing changed, if the snapshot's simulation had another fingerprint,
  /// apart from what is allowed to differ.
  void restore(const Snapshot& snapshot, const Allowed& allowed = {});
  /// Back to the moment of construction, bit for bit, as if it had been made with the seed.
  void reset(std::uint64_t seed);
  /// The same with the seed that it has.
  void reset() { reset(seed_); }

  /// Laws that plugins hand out beside their forces(). Valid as long as this simulation.
  const ForceLaws& force_laws() const { return laws_; }
  /// What flies, as force laws and engine have it now. Takes some milliseconds; nothing changes.
  VehicleDescription describe_vehicle();

  /// Names of all wrench terms, in the order of wrenches().
  const std::vector<std::string>& wrench_terms() const { return wrench_terms_; }
  /// What each term exerts in the present state, in the frame's axes about the vehicle's centre of
  /// mass.
  const std::vector<Wrench>& wrenches();

 private:
  void evaluate(Kinematics& kinematics, Loads& loads) const override;
  const ForceLaws& laws() const override { return laws_; }
  void evaluate_rest(Kinematics& kinematics, Loads& loads) const override;
  /// Blames the first plugin that makes the sum infinite or NaN.
  [[noreturn]] void refuse(const Kinematics& kinematics, Loads& loads) const override;
  void warn(const std::string& warning);  ///< nothing if empty
  std::string describe_idle(const Model& model) const;
  void load_plugins(const Model& model, const SimulationOptions& options);
  void check_drivers();  ///< throws if two plugins drive one joint
  void note_hooks();     ///< who has which, and in which order they are called
  void gather_laws();
  void prepare_plugins();  ///< tells those that ask what they fly
  Wrench probe(const VehicleState& state);
  AirResistance probe_air(const VehicleDescription& vehicle);
  void plant_seed(std::uint64_t seed);
  void place(const VehicleState& state);
  /// The engine for what rides on the frame with this state of the plugins; null if that is the
  /// present one.
  std::unique_ptr<Engine> another_engine(const VectorXd& plugin_state);
  void change_to(std::unique_ptr<Engine> engine);
  /// Lets another engine, if there must be one, go on as the frame moves.
  void take_along();
  /// Who is to blame, and why.
  std::string blamed() const;
  void begin();  ///< lets the sensors know where the motion begins
  void check_flight() const;
  /// What to do about a motion that got out of hand, or the warning that told it.
  std::string advice() const;
  void move();          ///< makes a step by motion_
  void show_state();    ///< brings state_ up to date
  void show_instant();  ///< writes time and air into the engine's motion
  void blow(Kinematics& kinematics) const;
  void push(const std::vector<const LoadedPlugin*>& plugins, const Kinematics& kinematics,
            Loads& loads) const;
  PluginState state_of(const LoadedPlugin& p) {
    return {plugin_state_.data() + p.state_begin, p.state_size};
  }
  ConstPluginState state_of(const LoadedPlugin& p) const {
    return {plugin_state_.data() + p.state_begin, p.state_size};
  }
  /// The hook of a plugin runs next: who to blame, and whose messages those are.
  void enter(const LoadedPlugin& p) {
    active_ = &p;
    topics_.write_as(static_cast<int>(&p - plugins_.data()));
  }
  void leave() {
    active_ = nullptr;
    topics_.write_as(the_caller);
  }
  void publish(const char* call, std::size_t topic, const double* values);
  /// Calls a hook of those that have it.
  template <auto hook>
  void sample(const std::vector<const LoadedPlugin*>& plugins, bool jumped);
  void update();
  void sense(bool jumped);
  /// Adds to warnings() what the active plugin has said in a hook.
  void collect_warnings();
  /// Records why the flight ended and throws FlightError.
  [[noreturn]] void fail(const std::string& what);

  std::string engine_name_;
  const Model model_;  ///< as the URDF has it
  const World world_;
  double dt_;
  std::uint64_t seed_ = 0;
  std::shared_ptr<const Fingerprint> fingerprint_;
  std::vector<std::string> warnings_;
  std::size_t warnings_at_load_ = 0;  ///< the first of warnings_, which are not of a flight
  std::vector<std::string> said_;     ///< by the plugin whose hook is running
  std::vector<std::string> ignored_;
  Topics topics_;
  std::vector<LoadedPlugin> plugins_;
  /// Those that have a hook, in the order in which it is called: of update and sense that of
  /// topics, else by name.
  struct {
    std::vector<const LoadedPlugin*> update, sense, forces, forces_without_laws, air, carried;
  } with_;
  ForceLaws laws_;
  bool windy_ = false;  ///< whether anything moves the air
  std::vector<std::string> wrench_terms_;
  std::unique_ptr<Engine> engine_;
  std::vector<CarriedBody> carried_;  ///< by the engine's vehicle
  std::vector<CarriedBody> asked_;    ///< for, most recently
  int command_topic_ = -1;
  Motion motion_;  ///< in the engine's place, if there is one

  double start_time_ = 0;
  std::int64_t steps_ = 0;
  VectorXd plugin_state_;
  VehicleState state_;
  std::string failure_;                           ///< why the flight ended; "" while it goes on
  mutable const LoadedPlugin* active_ = nullptr;  ///< whose hook is running, to blame it
  Snapshot initial_;                              ///< before anything was sensed

  Loads wrench_loads_;
  std::vector<Wrench> wrenches_;
};

}  // namespace quadcore
