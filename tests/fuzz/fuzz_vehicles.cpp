#include "fuzz_vehicles.hpp"

#include "quadcore/engine.hpp"
#include "quadcore/plugin/document.hpp"

using namespace quadcore;

std::unique_ptr<Simulation> FuzzVehicle::simulate(
    const std::map<std::string, std::string>& parameters) const {
  World world;
  world.ground_plane = true;
  SimulationOptions options;
  options.engine = engine;
  options.parameters = parameters;
  options.spawn.xyz.z() = 0.5;
  return std::make_unique<Simulation>(model, world, options);
}

std::vector<FuzzVehicle> fuzz_vehicles() {
  std::vector<FuzzVehicle> all;
  for (const char* name : {"sensors", "flown", "rotors"}) {
    const std::string file = std::string(FUZZ_VEHICLES "/") + name + ".urdf";
    for (const EngineInfo& engine : engines()) {
      all.push_back({read_model(Document::read(file)), engine.name});
    }
  }
  return all;
}
