#pragma once

#include <cmath>

#include "shapes.hpp"
#include "states.hpp"

/// \file
/// Vehicles at the ground in the engine eigen.

namespace quadcore::test {

constexpr double dt = 1e-3, g = 9.8;

/// Whose gravity leans by an angle [rad] towards a heading [rad], as it does to one on a slope.
inline World ground(double lean = 0, double heading = 0) {
  World world;
  world.ground_plane = true;
  world.gravity_W = {g * std::sin(lean) * std::cos(heading), g * std::sin(lean) * std::sin(heading),
                     -g * std::cos(lean)};
  return world;
}

inline Model bare(const std::string& geometry, const std::string& tags = "") {
  return model(shaped("frame", shape(geometry, "xyz=\"0.02 -0.01 0.03\""),
                      inertial("1.3", skew_body, "xyz=\"0.02 -0.01 0.01\"")) +
               tags);
}

/// Mass off the origin, a foot, a hull and a rotor that has a disc, in different places.
inline Model vehicle() {
  return model(
      shaped("frame",
             shape("<box size=\"0.3 0.2 0.08\"/>", "xyz=\"0.01 0.02 -0.03\" rpy=\"0.1 -0.2 0.3\"") +
                 shape("<sphere radius=\"0.03\"/>", "xyz=\"-0.1 0.05 -0.08\"") +
                 shape("<cylinder radius=\"0.05\" length=\"0.2\"/>", "xyz=\"0.1 -0.1 0.02\""),
             inertial("1.1", skew_body, "xyz=\"0.01 -0.02 0.03\"")) +
      shaped("rotor", shape("<cylinder radius=\"0.1\" length=\"0.01\"/>"),
             inertial("0.02", round_rotor)) +
      "<joint name=\"turn\" type=\"continuous\"><parent link=\"frame\"/><child link=\"rotor\"/>"
      "<origin xyz=\"0.15 0.1 0.07\" rpy=\"0.2 -0.1 0\"/><axis xyz=\"0 0 1\"/></joint>");
}

inline void fly(Engine& engine, int steps) {
  for (int i = 0; i < steps; ++i) engine.step(i * dt, dt, NoForces());
}

/// The same, and `each` is called after every step.
template <class Each>
void fly(Engine& engine, int steps, const Each& each) {
  for (int i = 0; i < steps; ++i) {
    fly(engine, 1);
    each();
  }
}

inline VehicleState state_of(Engine& engine) {
  VehicleState state = blank(static_cast<Eigen::Index>(engine.model().joints.size()));
  engine.get_state(state);
  return state;
}

}  // namespace quadcore::test
