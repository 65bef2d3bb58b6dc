#include "eigen/eigen_engine.hpp"
#include "ode/ode_engine.hpp"
#include "ode/shared_world.hpp"
#include "quadcore/engine.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

/// Stability limit of the semi-implicit Euler step, v' = (1 - r dt) v.
constexpr double decay_limit_of_euler = 2;
/// Stability limit of the classical Runge-Kutta method: 1 - z + z^2/2 - z^3/6 + z^4/24 = 1 at z = r
/// dt (Hairer, Wanner, "Solving Ordinary Differential Equations II", ch. IV.2).
constexpr double decay_limit_of_rk4 = 2.785293563405282;

struct EngineEntry {
  EngineInfo info;
  std::unique_ptr<Engine> (*make)(const Model&, const World&);
  std::unique_ptr<SharedWorld> (*share)(const std::vector<Engine*>&, const World&);
};

std::unique_ptr<SharedWorld> share_in_ode(const std::vector<Engine*>& engines, const World& world) {
  std::vector<OdeEngine*> of_ode;
  for (Engine* const engine : engines) of_ode.push_back(&dynamic_cast<OdeEngine&>(*engine));
  return std::make_unique<OdeSharedWorld>(of_ode, world);
}

const std::vector<EngineEntry>& table() {
  static const std::vector<EngineEntry> entries = {
      {{"gazebo11", "ODE as in Gazebo 11: bit-identical results, including its known errors",
        decay_limit_of_euler, false},
       [](const Model& model, const World& world) -> std::unique_ptr<Engine> {
         return std::make_unique<OdeEngine>(model, world, gazebo11_recipe);
       },
       &share_in_ode},
      {{"ode",
        "the same ODE world with the correct gyroscopic torque and the URDF's unrounded numbers",
        decay_limit_of_euler, false},
       [](const Model& model, const World& world) -> std::unique_ptr<Engine> {
         return std::make_unique<OdeEngine>(model, world, ode_recipe);
       },
       &share_in_ode},
      {{"eigen",
        "reduced coordinates, fourth order: the most accurate and fastest engine; approximate "
        "ground contact",
        decay_limit_of_rk4, true},
       [](const Model& model, const World& world) -> std::unique_ptr<Engine> {
         return std::make_unique<EigenEngine>(model, world);
       },
       [](const std::vector<Engine*>& engines, const World&) {
         return std::make_unique<SharedWorld>(engines);
       }},
  };
  return entries;
}

const EngineEntry& entry(const std::string& name) {
  std::vector<std::string> names;
  for (const EngineEntry& entry : table()) {
    if (entry.info.name == name) return entry;
    names.push_back(entry.info.name);
  }
  throw InputError("engine '" + name + "' does not exist." + suggest(name, names) +
                   " Choose one of " + joined(names) + ".");
}

}  // namespace

const ForceLaws& ForceField::laws() const {
  static const ForceLaws none;
  return none;
}

void ForceField::refuse(const Kinematics&, Loads&) const {
  throw Error("a force or torque is not a finite number");
}

void Engine::get_motion(VehicleState& state) {
  const Kinematics& k = kinematics();
  state.position = k.p_WF;
  state.orientation = k.q_WF;
  state.linear_velocity = k.R_WF * k.v_WF_F;
  state.angular_velocity = k.w_WF_F;
  for (std::size_t i = 0; i < k.rotors.size(); ++i) {
    state.rotor_velocity[static_cast<Eigen::Index>(i)] = k.rotors.number(MotionRow::rate, i);
  }
}

void Engine::get_state(VehicleState& state) {
  get_motion(state);
  const Kinematics& k = kinematics();
  for (std::size_t i = 0; i < k.rotors.size(); ++i) {
    state.rotor_angle[static_cast<Eigen::Index>(i)] = k.angle(i);
  }
}

void SharedWorld::step(double dt, const std::vector<TimedForces>& forces) {
  for (current_ = 0; current_ < engines_.size(); ++current_) {
    engines_[current_]->step(forces[current_].time, dt, *forces[current_].field);
  }
}

void SharedWorld::restore(const std::vector<double>& saved) {
  if (saved.empty()) return;
  throw InputError(
      "snapshot: it was taken in another world or engine. Restore a snapshot of this fleet.");
}

std::vector<std::string> SharedWorld::warnings() const {
  return {
      "the vehicles pass through each other, because this engine does not simulate contact between "
      "vehicles. Use gazebo11 or ode for collisions."};
}

std::vector<EngineInfo> engines() {
  std::vector<EngineInfo> infos;
  for (const EngineEntry& entry : table()) infos.push_back(entry.info);
  return infos;
}

const EngineInfo& engine_info(const std::string& name) { return entry(name).info; }

std::unique_ptr<Engine> make_engine(const std::string& name, const Model& model,
                                    const World& world) {
  return entry(name).make(model, world);
}

std::unique_ptr<SharedWorld> share_world(const std::string& name,
                                         const std::vector<Engine*>& engines, const World& world) {
  return entry(name).share(engines, world);
}

}  // namespace quadcore
