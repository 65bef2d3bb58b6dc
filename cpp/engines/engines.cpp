#include "eigen/eigen_engine.hpp"
#include "ode/ode_engine.hpp"
#include "quadcore/engine.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

/// Of the semi-implicit Euler step: v' = (1 - r dt) v.
constexpr double decay_limit_of_euler = 2;
/// Of the classical Runge-Kutta method: 1 - z + z^2/2 - z^3/6 + z^4/24 = 1 at z = r dt (Hairer,
/// Wanner, "Solving Ordinary Differential Equations II", ch. IV.2).
constexpr double decay_limit_of_rk4 = 2.785293563405282;

struct EngineEntry {
  EngineInfo info;
  std::unique_ptr<Engine> (*make)(const Model&, const World&);
};

const std::vector<EngineEntry>& table() {
  static const std::vector<EngineEntry> entries = {
      {{"gazebo11", "ODE set up to do what Gazebo 11 does to the last digit, faults included",
        decay_limit_of_euler, false},
       [](const Model& model, const World& world) -> std::unique_ptr<Engine> {
         return std::make_unique<OdeEngine>(model, world, gazebo11_recipe);
       }},
      {{"ode", "the same ODE world with the right gyroscopic torque and the URDF's own numbers",
        decay_limit_of_euler, false},
       [](const Model& model, const World& world) -> std::unique_ptr<Engine> {
         return std::make_unique<OdeEngine>(model, world, ode_recipe);
       }},
      {{"eigen",
        "exact reduced coordinates, fourth order: the accurate and the fast one, approximate on "
        "the ground",
        decay_limit_of_rk4, true},
       [](const Model& model, const World& world) -> std::unique_ptr<Engine> {
         return std::make_unique<EigenEngine>(model, world);
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
  throw InputError("engine '" + name + "' is not there" + did_you_mean(name, names) +
                   "; choose one of " + joined(names));
}

}  // namespace

const ForceLaws& ForceField::laws() const {
  static const ForceLaws none;
  return none;
}

void ForceField::refuse(const Kinematics&, Loads&) const {
  throw Error("a force or torque is not a finite number");
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

}  // namespace quadcore
