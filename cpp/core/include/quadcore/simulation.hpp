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
#include "quadcore/total_variation.hpp"

namespace quadcore QUADCORE_EXPORT {

/// A loaded plugin of the model.
struct LoadedPlugin {
  std::string name;                    ///< PluginElement::name, made unique
  std::string filename;                ///< PluginElement::filename
  std::string path;                    ///< PluginLibrary::path
  const PluginDescriptor* descriptor;  ///< description by its module
  Parameters parameters;               ///< effective parameters
  std::unique_ptr<Plugin> plugin;      ///< constant once the simulation is created
  Eigen::Index state_begin = 0;        ///< start of its values in Snapshot::plugin_state
  Eigen::Index state_size = 0;         ///< number of its values
  std::size_t term_begin = 0;          ///< index of its first wrench term
  std::string who = {};                ///< name for errors: FILE:LINE: plugin 'name'
  std::uint64_t seed = 0;              ///< seed of its random numbers
  std::size_t quiet = 0;  ///< place of its bounds in ForceLaws::quiet, if all have some
};

/// Complete state of a simulation as plain numbers and texts.
struct Snapshot {
  std::shared_ptr<const Fingerprint> taken_from;  ///< fingerprint of the simulation
  double start_time = 0;                          ///< time of the first step [s]
  std::int64_t steps = 0;                         ///< number of steps since then
  std::uint64_t seed = 0;                         ///< seed of all random numbers
  std::vector<double> engine;                     ///< result of Engine::save()
  VectorXd plugin_state;              ///< state of all plugins, see LoadedPlugin::state_begin
  std::vector<Message> messages;      ///< last message of each topic
  std::vector<std::string> warnings;  ///< warnings of the flight
  std::string failure;                ///< reason of a failure, or ""
};

/// Options of a simulation.
struct SimulationOptions {
  std::string engine = "gazebo11";  ///< one of engines()
  std::optional<double> dt =
      {};                  ///< time step, at least 1e-9 [s]; the world's max_step_size if absent
  std::uint64_t seed = 0;  ///< seed of all random numbers
  /// "PLUGIN.TAG" -> value, which overrides the URDF.
  std::map<std::string, std::string> parameters = {};
  Pose spawn = {};  ///< initial pose of the frame in the world
};

/// One vehicle in one world with plugins and an engine. The caller advances it, or the Fleet that
/// it belongs to.
class Simulation : private ForceField {
 public:
  /// Limit of angular velocities and joint rates at which a flight counts as diverged [rad/s].
  static constexpr double max_rate = 1e6;
  /// Topic of command().
  static constexpr const char* command_topic = "vel_cmd";

  /// Load the model's plugins and prepare the start of the flight. Throws InputError, with
  /// FILE:LINE for errors in a document.
  Simulation(Model model, const World& world, const SimulationOptions& options);

  /// Publish signed rotor speeds [rad/s] on topic `vel_cmd`. Throws InputError without changes for
  /// a wrong count, a number that is not finite, or if a plugin writes the topic.
  void command(const double* speeds, std::size_t count);
  /// Publish a message on a topic that no plugin writes. Throws InputError without changes for a
  /// topic that does not exist or that a plugin writes, a wrong count, or a number that is not
  /// finite.
  void publish(const std::string& topic, const double* values, std::size_t count);
  /// A function that changes the state to that after a step of dt [s] under the last published
  /// command of rotor speeds [rad/s], which is zero before the first.
  using Motion = std::function<void(double dt, const VectorXd& command, VehicleState& state)>;
  /// Replace the engine's steps by a motion. Plugins still update and sense, but their forces have
  /// no effect, and there is no contact.
  void move_by(Motion motion);
  /// Advance by n steps. Throws FlightError if the flight fails; afterwards only restore, reset and
  /// set_state make the simulation usable again.
  /// \param rates  unless null, the joint rates after each step are added to it
  void step(std::int64_t n = 1, TotalVariation* rates = nullptr);
  /// Return whether a plugin accepts command().
  bool takes_commands() const;
  /// Return the number of values in a command. Throws InputError if no plugin accepts commands.
  std::size_t command_width() const;

  /// Return the simulation time [s].
  double time() const { return time_after(0); }
  /// Return the simulation time after so many more steps [s].
  double time_after(double steps) const {
    return start_time_ + (static_cast<double>(steps_) + steps) * dt_;
  }
  /// Return the time step [s].
  double dt() const { return dt_; }
  /// Return the name of the engine.
  const std::string& engine_name() const { return engine_name_; }
  /// Return the integration method of the engine in one line.
  std::string method() const { return engine_->method(); }
  /// Return the present motion of the world's free bodies, in the order of World::free_bodies.
  std::vector<FreeBodyState> free_bodies() const { return engine_->free_bodies(); }
  /// Return the model as the engine simulates it, including attached bodies.
  const Model& model() const { return engine_->model(); }
  /// Return the number of rotor joints.
  std::size_t rotor_count() const { return model_.joints.size(); }
  /// Return the names of the rotor joints, in the order of all rotor quantities.
  std::vector<std::string> rotor_names() const { return model_.joint_names(); }
  /// Return the description of each joint by the plugins. It lacks what describe_vehicle() measures
  /// and what plugins compute from that, such as the lag.
  const std::vector<RotorDescription>& drives() const { return drives_; }
  /// Return the world.
  const World& world() const { return world_; }
  /// Return the fingerprint of everything that a flight depends on in addition to its state.
  const Fingerprint& fingerprint() const { return *fingerprint_; }
  /// Return the present state, which is computed on request. Call this again after a step, and not
  /// from two threads at once.
  const VehicleState& state() const {
    if (has_old_angles_) show_state();
    return state_;
  }
  /// The same for callers that do not read the joint angles, which are not updated.
  const VehicleState& motion() const {
    if (is_outdated_) show_motion();
    return state_;
  }
  /// Return the topics of plugins and callers.
  const Topics& topics() const { return topics_; }
  /// Return the plugins in the order of the URDF.
  const std::vector<LoadedPlugin>& plugins() const { return plugins_; }
  /// Return whether odometry gives the linear velocity in frame axes. All plugins with the tag
  /// `twistFrame` agree on it.
  bool has_velocity_in_body() const;
  /// Return the warnings: first those of loading the model and its plugins, then those of this
  /// flight. The latter are part of a snapshot, and a reset removes them.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// Return the names of elements of model and world that the user ignored, and what of the world
  /// is not simulated.
  const std::vector<std::string>& ignored() const { return ignored_; }

  /// Set the state. Throws InputError for a state that is not finite or has wrong sizes.
  void set_state(const VehicleState& state);
  /// Return the complete state.
  Snapshot snapshot() const;
  /// Restore a snapshot. Throws InputError without changes if the snapshot's fingerprint differs in
  /// parts that may not differ.
  void restore(const Snapshot& snapshot, const Allowed& allowed = {});
  /// Reset exactly to the state after construction with this seed.
  void reset(std::uint64_t seed);
  /// Reset with the present seed.
  void reset() { reset(seed_); }

  /// Return the force laws that plugins provide. Valid for the lifetime of this simulation.
  const ForceLaws& force_laws() const { return laws_; }
  /// Return a description of the vehicle, valid until a step. The first call takes some
  /// milliseconds; none changes anything.
  const VehicleDescription& describe_vehicle();

  /// Return the names of all wrench terms, in the order of wrenches().
  const std::vector<std::string>& wrench_terms() const { return wrench_terms_; }
  /// Return the wrench of each term in the present state, in frame axes about the vehicle's centre
  /// of mass.
  const std::vector<Wrench>& wrenches();

 private:
  friend class Fleet;

  void evaluate(Kinematics& kinematics, Loads& loads) const override;
  const ForceLaws& laws() const override { return laws_; }
  void evaluate_rest(Kinematics& kinematics, Loads& loads) const override;
  /// Throw Error that names the first plugin with loads that are not finite.
  [[noreturn]] void refuse(const Kinematics& kinematics, Loads& loads) const override;
  void warn(const std::string& warning);  ///< ignores ""
  std::string describe_idle(const Model& model) const;
  void load_plugins(const Model& model, const SimulationOptions& options);
  /// Note the radii of the rotors. Throws if two plugins drive the same joint.
  void check_drivers();
  void note_hooks();  ///< collects the plugins with each hook in calling order
  void gather_laws();
  void prepare_plugins();  ///< calls the plugins' prepare()
  VehicleDescription probe_vehicle();
  Wrench probe(const VehicleState& state);
  AirResistance probe_air(const VehicleDescription& vehicle);
  void plant_seed(std::uint64_t seed);
  void place(const VehicleState& state);
  /// Return a new engine if this plugin state attaches other bodies to the frame, else null.
  std::unique_ptr<Engine> another_engine(const VectorXd& plugin_state);
  void change_to(std::unique_ptr<Engine> engine);
  /// Continue with a new engine if the attached bodies have changed.
  void take_along();
  /// Return the current exception's message with the plugin that raised it.
  std::string blamed() const;
  std::unique_ptr<Engine> create_engine(const Model& model) const;
  void check_usable() const;  ///< throws FlightError if the flight has failed
  bool observes() const { return !with_.observe.empty(); }
  /// Write what plugins of other vehicles may see.
  void show_to_others(OtherVehicle& seen);
  void observe(const OtherVehicles& others);
  /// Return whether the update() of a plugin has no effect now. `news` is a set of Topics::news().
  bool is_quiet(const LoadedPlugin& p, std::uint64_t news) const;
  bool are_quiet() const;  ///< whether no update() has an effect now
  void begin_step();
  void end_step();
  void begin();  ///< runs the sensors at the start of the motion
  void check_flight() const;
  /// Return advice on a diverged motion, or the last warning of this flight.
  std::string advice() const;
  void move();               ///< advances one step by motion_
  void show_motion() const;  ///< updates state_ except the joint angles
  void show_state() const;   ///< updates state_
  void show_instant();       ///< writes time and air velocity into the engine's motion
  void blow(Kinematics& kinematics) const;
  void push(const std::vector<const LoadedPlugin*>& plugins, const Kinematics& kinematics,
            Loads& loads) const;
  PluginState state_of(const LoadedPlugin& p) {
    return {plugin_state_.data() + p.state_begin, p.state_size};
  }
  ConstPluginState state_of(const LoadedPlugin& p) const {
    return {plugin_state_.data() + p.state_begin, p.state_size};
  }
  /// Set the plugin that runs next, for errors and published messages.
  void enter(const LoadedPlugin& p) {
    active_ = &p;
    topics_.write_as(static_cast<int>(&p - plugins_.data()));
  }
  void leave() {
    active_ = nullptr;
    topics_.write_as(the_caller);
  }
  void publish(const char* call, std::size_t topic, const double* values);
  /// Call a hook of the given plugins by call(plugin, sample, state).
  template <class Call>
  void sample(const std::vector<const LoadedPlugin*>& plugins, bool jumped, const Call& call);
  void update();
  void sense(bool jumped);
  /// Add the active plugin's new warnings to warnings().
  void collect_warnings();
  /// Record the reason of the failure and throw FlightError.
  [[noreturn]] void fail(const std::string& what);

  std::string engine_name_;
  const Model model_;  ///< model of the URDF
  const World world_;
  bool in_fleet_ = false;  ///< whether a Fleet moves the free bodies
  double dt_;
  std::uint64_t seed_ = 0;
  std::shared_ptr<const Fingerprint> fingerprint_;
  std::vector<std::string> warnings_;
  std::size_t warnings_at_load_ = 0;  ///< number of warnings_ from loading
  std::vector<std::string> said_;     ///< new warnings of the plugin whose hook is running
  std::vector<std::string> ignored_;
  Topics topics_;
  std::vector<LoadedPlugin> plugins_;
  /// Plugins with each hook in calling order: observe, update and sense in the order of topics,
  /// others by name.
  struct {
    std::vector<const LoadedPlugin*> observe, update, sense, forces, forces_without_laws, air,
        carried;
  } with_;
  ForceLaws laws_;
  std::vector<double> radii_;             ///< RotorDescription::radius of each rotor [m]
  std::vector<RotorDescription> drives_;  ///< see drives()
  bool windy_ = false;                    ///< whether the air may move
  std::vector<std::string> wrench_terms_;
  std::unique_ptr<Engine> engine_;
  std::optional<VehicleDescription> description_;  ///< of the engine's model; absent until asked
  std::vector<CarriedBody> carried_;               ///< bodies attached in the engine's model
  std::vector<CarriedBody> asked_;                 ///< bodies that plugins attached most recently
  int command_topic_ = -1;
  Motion motion_;  ///< replaces the engine's steps, if set

  double start_time_ = 0;
  std::int64_t steps_ = 0;
  VectorXd plugin_state_;
  mutable VehicleState state_;                    ///< see state()
  mutable bool is_outdated_ = false;              ///< whether steps followed state_
  mutable bool has_old_angles_ = false;           ///< whether steps followed its joint angles
  VehicleState start_;                            ///< state in which the simulation was made
  std::string failure_;                           ///< reason of a failure, or ""
  mutable const LoadedPlugin* active_ = nullptr;  ///< plugin whose hook is running, for errors
  Snapshot initial_;                              ///< state before the sensors ran

  Loads wrench_loads_;
  std::vector<Wrench> wrenches_;
};

}  // namespace quadcore
