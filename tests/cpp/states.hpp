#pragma once

#include <cmath>

#include "quadcore/plugin/random.hpp"
#include "quadcore/plugin/world.hpp"
#include "quadcore/state.hpp"

namespace quadcore::test {

inline Vector3d random_vector(std::uint64_t seed, double& count) {
  return {random_normal(seed, count), random_normal(seed, count), random_normal(seed, count)};
}

inline VehicleState random_state(std::uint64_t seed, Eigen::Index rotors) {
  double count = 0;
  VehicleState state;
  state.position = 10 * random_vector(seed, count);
  state.orientation.coeffs().head<3>() = random_vector(seed, count);
  state.orientation.w() = random_normal(seed, count);
  state.orientation.normalize();
  state.linear_velocity = 5 * random_vector(seed, count);
  state.angular_velocity = 2 * random_vector(seed, count);
  state.rotor_velocity.resize(rotors);
  state.rotor_angle.resize(rotors);
  for (Eigen::Index i = 0; i < rotors; ++i) {
    state.rotor_velocity[i] = 100 * random_normal(seed, count);
    state.rotor_angle[i] = std::remainder(2 * random_normal(seed, count), 2 * M_PI);
  }
  return state;
}

inline VehicleState blank(Eigen::Index rotors) {
  VehicleState state;
  state.rotor_velocity = state.rotor_angle = VectorXd::Zero(rotors);
  return state;
}

inline World weightless() {
  World world;
  world.gravity_W.setZero();
  return world;
}

}  // namespace quadcore::test
