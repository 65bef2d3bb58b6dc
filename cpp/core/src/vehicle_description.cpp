#include "quadcore/vehicle_description.hpp"

#include <algorithm>

#include "quadcore/simulation.hpp"

namespace quadcore {
namespace {

/// At which rotors are probed [rad/s]: a thrust and a torque that go with its square are then the
/// coefficients themselves.
constexpr double probed_rate = 1;

Wrench operator-(const Wrench& a, const Wrench& b) {
  return {a.force_F - b.force_F, a.torque_F - b.torque_F};
}

}  // namespace

void Simulation::prepare_plugins() {
  const auto asks = [](const LoadedPlugin& p) { return p.descriptor->create.hooks.prepare; };
  if (std::none_of(plugins_.begin(), plugins_.end(), asks)) return;
  const VehicleDescription vehicle = describe_vehicle();
  for (const LoadedPlugin& p : plugins_) {
    if (!asks(p)) continue;
    active_ = &p;
    p.plugin->prepare(vehicle);
  }
  active_ = nullptr;
}

VehicleDescription Simulation::describe_vehicle() {
  const Model& flown = engine_->model();
  VehicleDescription vehicle{mass_properties(flown), world_.gravity_W, {}};
  const std::vector<Eigen::Isometry3d> poses = link_poses(flown);
  const Wrench still = probe(state_);
  for (std::size_t i = 0; i < flown.joints.size(); ++i) {
    const Eigen::Isometry3d& pose = poses[i + 1];
    const auto turning = [&](double rate) {
      VehicleState rest = state_;
      rest.rotor_velocity[static_cast<Eigen::Index>(i)] = rate;
      return probe(rest) - still;
    };
    vehicle.rotors.push_back({flown.joints[i].name, pose.translation(),
                              pose * flown.links[i + 1].inertial.pose.xyz,
                              pose.linear() * flown.joints[i].axis, moment_about_joint(flown, i),
                              turning(probed_rate), turning(-probed_rate)});
  }
  return vehicle;
}

/// Force and torque about the vehicle's centre of mass in a state in still air.
Wrench Simulation::probe(const VehicleState& state) {
  engine_->set_state(state);
  Kinematics& k = engine_->kinematics();
  k.v_WA_F.setZero();
  Loads loads(k.rotors.size());
  push(with_.forces, k, loads);
  Wrench sum = loads.frame();
  for (std::size_t i = 0; i < k.rotors.size(); ++i) {
    const Vector3d f_F = loads.rotor_force_F(i);
    sum.force_F += f_F;
    sum.torque_F += k.rotors[i].p_FRcm_F.cross(f_F);
  }
  sum.torque_F -= k.p_FCcm_F.cross(sum.force_F);
  return sum;
}

}  // namespace quadcore
