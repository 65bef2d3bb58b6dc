#include "members.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "flight_checks.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::batch {
namespace {

VehicleState at_rest(const Pose& spawn, std::size_t rotors) {
  VehicleState state;
  state.position = spawn.xyz;
  state.orientation = spawn.rotation();
  state.rotor_velocity = state.rotor_angle = VectorXd::Zero(static_cast<Eigen::Index>(rotors));
  return state;
}

}  // namespace

bool are_built_alike(const BatchVehicle& a, const BatchVehicle& b) {
  return a.model == b.model && a.parameters == b.parameters;
}

void write_state(const VehicleState& state, double* row) {
  row = std::copy_n(state.position.data(), 3, row);
  row = std::copy_n(state.orientation.coeffs().data(), 4, row);
  row = std::copy_n(state.linear_velocity.data(), 3, row);
  row = std::copy_n(state.angular_velocity.data(), 3, row);
  row = std::copy_n(state.rotor_velocity.data(), state.rotor_velocity.size(), row);
  std::copy_n(state.rotor_angle.data(), state.rotor_angle.size(), row);
}

VehicleState read_state(const double* row, Eigen::Index rotors) {
  VehicleState state;
  state.position = Eigen::Map<const Vector3d>(row);
  state.orientation.coeffs() = Eigen::Map<const Eigen::Vector4d>(row + 3);
  state.linear_velocity = Eigen::Map<const Vector3d>(row + 7);
  state.angular_velocity = Eigen::Map<const Vector3d>(row + 10);
  state.rotor_velocity = Eigen::Map<const VectorXd>(row + StateRow::joints, rotors);
  state.rotor_angle = Eigen::Map<const VectorXd>(row + StateRow::joints + rotors, rotors);
  return state;
}

void check(const VehicleState& state, std::size_t vehicle) {
  try {
    check_state(state, state.rotor_velocity.size());
  } catch (const InputError& error) {
    throw InputError("vehicle " + std::to_string(vehicle) + ": " + error.what());
  }
}

void Member::add_warnings(const std::vector<std::string>& added) {
  const auto what = [](const std::string& warning) { return warning.substr(warning.find(':')); };
  for (const std::string& warning : added) {
    const auto of_flight = warnings.begin() + static_cast<std::ptrdiff_t>(warned_at_load);
    const bool is_known = std::any_of(of_flight, warnings.end(), [&](const std::string& other) {
      return what(other) == what(warning);
    });
    if (!is_known) warnings.push_back(warning);
  }
}

std::unique_ptr<Simulation> Common::simulate(const BatchVehicle& vehicle) const {
  SimulationOptions options = options_;
  options.parameters = vehicle.parameters;
  options.spawn = vehicle.spawn;
  options.seed = vehicle.seed;
  return std::make_unique<Simulation>(*vehicle.model, world_, options);
}

void Common::check(std::size_t i, Simulation& made) {
  if (i > 0) {
    if (made.rotor_count() == rotors_ && made.command_width() == command_width_) return;
    throw InputError("vehicle " + std::to_string(i) + " has " + std::to_string(made.rotor_count()) +
                     " rotors, but vehicle 0 has " + std::to_string(rotors_) +
                     ". Make a separate batch for each number of rotors.");
  }
  dt_ = made.dt();
  command_width_ = made.command_width();
  rotors_ = made.rotor_count();
  const Snapshot start = made.snapshot();
  try {
    made.command(std::vector<double>(command_width_).data(), command_width_);
  } catch (const InputError& error) {
    refused_ = error.what();
  }
  made.restore(start);
}

void Common::check(const double* commands, std::size_t vehicles) const {
  if (!refused_.empty()) throw InputError(refused_);
  for (std::size_t k = 0; k < vehicles * command_width_; ++k) {
    if (std::isfinite(commands[k])) continue;
    std::ostringstream what;
    what << "the command for rotor " << k % command_width_ + 1 << " of vehicle "
         << k / command_width_ << " is " << commands[k] << ". Give a finite speed in rad/s.";
    throw InputError(what.str());
  }
}

Members make_members(std::vector<BatchVehicle> vehicles, Common& common) {
  if (vehicles.empty()) throw InputError("the batch has no vehicle. Give it at least one.");
  Members all{std::vector<Member>(vehicles.size()), {}};
  std::shared_ptr<const LaneVehicle> first;
  std::unique_ptr<Simulation> made;  // of the previous vehicle, if it is in the lanes
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    Member& member = all.members[i];
    member.vehicle = std::move(vehicles[i]);
    if (made && are_built_alike(member.vehicle, all.members[i - 1].vehicle)) {
      made->set_state(at_rest(member.vehicle.spawn, common.rotors()));
      all.in_lanes.push_back(all.in_lanes.back());
      member.sensors = all.members[i - 1].sensors;
    } else {
      made = common.simulate(member.vehicle);
      common.check(i, *made);
      std::optional<LaneVehicle> kind = lane_vehicle(*made);
      const bool fits = kind && (!first || fit(*kind, *first));
      all.in_lanes.push_back(fits ? std::make_shared<const LaneVehicle>(*std::move(kind))
                                  : nullptr);
      if (fits) {
        member.sensors = std::make_shared<const std::vector<LaneSensor>>(list_lane_sensors(*made));
      }
      if (!first) first = all.in_lanes.back();
    }
    member.warned_at_load = made->warnings().size();
    member.warnings = made->warnings();
    member.in_lanes = all.in_lanes.back() != nullptr;
    if (member.in_lanes) {
      member.start = made->snapshot().engine;
    } else {
      member.apart = std::move(made);
    }
  }
  return all;
}

}  // namespace quadcore::batch
