#include "quadcore/control/modelled_vehicle_file.hpp"

#include <algorithm>

#include "quadcore/plugin/error.hpp"
#include "quadcore/simulation.hpp"
#include "quadcore/text.hpp"

namespace quadcore::control {

VehicleDescription read_modelled_vehicle(const std::string& urdf, const VehicleDescription& flown) {
  const std::string macros = ".xacro";
  if (urdf.size() > macros.size() &&
      urdf.compare(urdf.size() - macros.size(), macros.size(), macros) == 0) {
    throw InputError(
        urdf + ": the modelled vehicle must be a URDF. Expand the file: `xacro FILE > URDF`.");
  }
  Model model = read_model(Document::read(urdf));
  // A controller in this file could name yet another modelled vehicle, without end.
  const auto is_controller = [](const PluginElement& plugin) {
    return plugin.filename == "libcontroller_plugin.so";
  };
  model.plugins.erase(std::remove_if(model.plugins.begin(), model.plugins.end(), is_controller),
                      model.plugins.end());
  World world;
  world.gravity_W = flown.gravity_W;
  SimulationOptions options;
  options.engine = "eigen";  // the exact engine
  return match_rotors(flown, Simulation(std::move(model), world, options).describe_vehicle(),
                      urdf + ": ");
}

VehicleDescription match_rotors(const VehicleDescription& flown, VehicleDescription modelled,
                                const std::string& who) {
  if (modelled.rotors.size() != flown.rotors.size()) {
    throw InputError(who + "has " + std::to_string(modelled.rotors.size()) +
                     " rotors, but the simulated vehicle has " +
                     std::to_string(flown.rotors.size()) + ". Use a vehicle with as many rotors.");
  }
  for (RotorDescription& rotor : modelled.rotors) {
    const auto same = [&](const RotorDescription& other) { return other.joint == rotor.joint; };
    const auto driven = std::find_if(flown.rotors.begin(), flown.rotors.end(), same);
    if (driven == flown.rotors.end()) {
      std::vector<std::string> names;
      for (const RotorDescription& other : flown.rotors) names.push_back(other.joint);
      throw InputError(who + "has a rotor '" + rotor.joint + "', but the simulated vehicle has " +
                       joined(names) + ". Give matching rotors the same name.");
    }
    rotor.place = driven->place;
  }
  return modelled;
}

}  // namespace quadcore::control
