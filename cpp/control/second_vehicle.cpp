#include "quadcore/control/second_vehicle.hpp"

#include <algorithm>

#include "quadcore/plugin/error.hpp"
#include "quadcore/simulation.hpp"
#include "quadcore/text.hpp"

namespace quadcore::control {

VehicleDescription second_vehicle(const std::string& urdf, const VehicleDescription& flown) {
  const std::string macros = ".xacro";
  if (urdf.size() > macros.size() &&
      urdf.compare(urdf.size() - macros.size(), macros.size(), macros) == 0) {
    throw InputError(urdf + ": a vehicle to believe in is a URDF; expand it, `xacro FILE > URDF`");
  }
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
  return driven_as(flown, Simulation(std::move(model), world, options).describe_vehicle(),
                   urdf + ": ");
}

VehicleDescription driven_as(const VehicleDescription& flown, VehicleDescription believed,
                             const std::string& who) {
  if (believed.rotors.size() != flown.rotors.size()) {
    throw InputError(who + "has " + std::to_string(believed.rotors.size()) +
                     " rotors; the vehicle that flies has " + std::to_string(flown.rotors.size()));
  }
  for (RotorDescription& rotor : believed.rotors) {
    const auto same = [&](const RotorDescription& other) { return other.joint == rotor.joint; };
    const auto driven = std::find_if(flown.rotors.begin(), flown.rotors.end(), same);
    if (driven == flown.rotors.end()) {
      std::vector<std::string> names;
      for (const RotorDescription& other : flown.rotors) names.push_back(other.joint);
      throw InputError(who + "has a rotor '" + rotor.joint +
                       "'; those of the vehicle that flies are " + joined(names) +
                       ", name it as its fellow there");
    }
    rotor.place = driven->place;
  }
  return believed;
}

}  // namespace quadcore::control
