#include "quadcore/control/second_vehicle.hpp"

#include <algorithm>

#include "quadcore/error.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::control {

VehicleDescription second_vehicle(const std::string& urdf, const VehicleDescription& flown) {
  Model model = read_model(Document::read(urdf));
  // One with a second vehicle of its own would have to be asked without end.
  const auto is_controller = [](const PluginElement& plugin) {
    return plugin.filename == "libcontroller_plugin.so";
  };
  model.plugins.erase(std::remove_if(model.plugins.begin(), model.plugins.end(), is_controller),
                      model.plugins.end());
  World world;
  world.gravity_W = flown.gravity_W;
  SimulationOptions options;
  options.engine = "eigen";  // without the faults of others
  VehicleDescription vehicle = Simulation(std::move(model), world, options).describe_vehicle();
  if (vehicle.rotors.size() != flown.rotors.size()) {
    throw InputError(urdf + ": has " + std::to_string(vehicle.rotors.size()) +
                     " rotors; the vehicle that flies has " + std::to_string(flown.rotors.size()));
  }
  return vehicle;
}

}  // namespace quadcore::control
