#include "quadcore/control/rotors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "quadcore/plugin/elementary.hpp"

namespace quadcore::control {
namespace {

/// Torques below this fraction of the thrust's moment count as zero.
constexpr double rounding = 1e-12;

/// Alternate the directions in the order of the rotors around the vehicle. Of the two ways, return
/// the one with the stronger yaw, or the one with a positive first rotor if they are equal.
std::vector<double> alternate(const VehicleDescription& vehicle,
                              const std::vector<std::size_t>& joints) {
  const std::size_t n = joints.size();
  if (n % 2 != 0) return {};
  std::vector<double> angles;
  for (const std::size_t joint : joints) {
    const Vector3d p_F = vehicle.rotors[joint].p_FRcm_F - vehicle.body.p_FCcm;
    angles.push_back(elementary::atan2(p_F.y(), p_F.x()));
  }
  std::vector<std::size_t> around(n);
  std::iota(around.begin(), around.end(), 0);
  std::stable_sort(around.begin(), around.end(),
                   [&](std::size_t i, std::size_t j) { return angles[i] < angles[j]; });
  std::vector<double> spins(n);
  for (std::size_t k = 0; k < n; ++k) spins[around[k]] = k % 2 == 0 ? 1 : -1;
  const auto turned = [&](double sense) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      sum += std::abs(wrench_of(vehicle.rotors[joints[i]], sense * spins[i]).torque_F.z());
    }
    return sum;
  };
  constexpr double equal = 1 + 1e-6;
  const double first = n > 0 ? spins[0] : 1;
  const double sense = turned(-first) > equal * turned(first) ? -first : first;
  for (double& spin : spins) spin *= sense;
  return spins;
}

}  // namespace

std::vector<double> find_spins(const VehicleDescription& vehicle,
                               const std::vector<std::size_t>& joints) {
  std::vector<double> spins;
  for (const std::size_t joint : joints) {
    if (vehicle.rotors[joint].spin == 0) return alternate(vehicle, joints);
    spins.push_back(vehicle.rotors[joint].spin);
  }
  return spins;
}

std::vector<Rotor> list_rotors(const VehicleDescription& vehicle) {
  std::vector<double> spins;
  for (const RotorDescription& rotor : vehicle.rotors) spins.push_back(rotor.spin);
  const std::vector<std::size_t> driven = vehicle.commanded();
  const std::vector<double> found = find_spins(vehicle, driven);
  for (std::size_t i = 0; i < found.size(); ++i) spins[driven[i]] = found[i];

  std::vector<Rotor> rotors;
  for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
    const RotorDescription& rotor = vehicle.rotors[i];
    const Wrench& wrench = wrench_of(rotor, spins[i]);
    const Vector3d moment_F = (rotor.p_FRcm_F - vehicle.body.p_FCcm).cross(wrench.force_F);
    double torque = rotor.axis_F.dot(wrench.torque_F - moment_F);
    if (std::abs(torque) <= rounding * moment_F.norm()) torque = 0;
    const double turning = spins[i] < 0 ? -1 : 1, squared = rotor.slowdown * rotor.slowdown;
    rotors.push_back({rotor.joint, rotor.p_FR_F, rotor.axis_F, spins[i],
                      rotor.axis_F.dot(wrench.force_F) / squared, std::abs(torque) / squared,
                      torque == 0 ? 0 : std::copysign(1, torque * turning), rotor.slowdown,
                      rotor.rate_per_command, rotor.lag, rotor.fastest, rotor.place});
  }
  return rotors;
}

}  // namespace quadcore::control
