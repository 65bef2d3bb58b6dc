#include "eigen/eigen_engine.hpp"
#include "ode/ode_engine.hpp"
#include "quadcore/engine.hpp"
#include "quadcore/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

struct EngineEntry {
  EngineInfo info;
  std::unique_ptr<Engine> (*make)(const Model&, const World&);
};

const std::vector<EngineEntry>& table() {
  static const std::vector<EngineEntry> entries = {
      {{"gazebo11", "ODE set up to do what Gazebo 11 does to the last digit, faults included"},
       [](const Model& model, const World& world) -> std::unique_ptr<Engine> {
         return std::make_unique<OdeEngine>(model, world, gazebo11_recipe);
       }},
      {{"ode", "the same ODE world with the right gyroscopic torque and the URDF's own numbers"},
       [](const Model& model, const World& world) -> std::unique_ptr<Engine> {
         return std::make_unique<OdeEngine>(model, world, ode_recipe);
       }},
      {{"eigen",
        "exact reduced coordinates, fourth order: the accurate and the fast one, no contact"},
       [](const Model& model, const World& world) -> std::unique_ptr<Engine> {
         return std::make_unique<EigenEngine>(model, world);
       }},
  };
  return entries;
}

}  // namespace

void ForceField::refuse(const Kinematics&, Loads&) const {
  throw Error("a force or torque is not a finite number");
}

std::vector<EngineInfo> engines() {
  std::vector<EngineInfo> infos;
  for (const EngineEntry& entry : table()) infos.push_back(entry.info);
  return infos;
}

std::unique_ptr<Engine> make_engine(const std::string& name, const Model& model,
                                    const World& world) {
  std::vector<std::string> names;
  for (const EngineEntry& entry : table()) {
    if (entry.info.name == name) return entry.make(model, world);
    names.push_back(entry.info.name);
  }
  throw InputError("engine '" + name + "' is not there" + did_you_mean(name, names) +
                   "; choose one of " + joined(names));
}

}  // namespace quadcore
