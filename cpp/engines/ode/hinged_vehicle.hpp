#pragma once

#include <ode/ode.h>

#include <vector>

#include "constraint_rows.hpp"
#include "gazebo_step.hpp"
#include "hinged_bodies.hpp"
#include "quadcore/kinematics.hpp"
#include "quadcore/loads.hpp"
#include "quadcore/model.hpp"
#include "quadcore/world.hpp"

namespace quadcore {

/// What HingedBodies take of models.
struct HingedModel {
  std::vector<std::size_t> carriers;
  std::vector<char> carries, brakes;
  std::vector<double> constants;  ///< rows of BodyConstant, body by body

  explicit HingedModel(const Model& model);
  HingedTree tree(const World& world) const;
};

/// A vehicle's bodies as HingedBodies, beside those in an ODE world.
class HingedVehicle {
 public:
  HingedVehicle(const Model& model, const World& world);

  /// Takes over the state of bodies in ODE, one for each link.
  void take(const std::vector<dBodyID>& bodies);
  /// Takes over the forces that have been added to them.
  void take_forces(const std::vector<dBodyID>& bodies);
  /// Gives them this state, and no forces.
  void give(const std::vector<dBodyID>& bodies) const;

  /// Adds the loads on the vehicle and the damping of its joints.
  void push(const Loads& loads);
  /// Advances by dt, with the gyroscopic torque of each body by itself or without.
  void advance(double dt, bool gyroscopic);
  /// Writes how the vehicle moves.
  void show(Kinematics& kinematics) const;

  /// What a hinge has exerted in the last step.
  GazeboStep::Multipliers multipliers(std::size_t hinge) const;

  /// Whether body i keeps further than `reach` [m] above the ground for a time [s], falling freely.
  bool is_high(std::size_t i, double reach, double time, double gravity_z) const;

 private:
  using Bodies = HingedBodies<double, 1>;
  Bodies bodies() const;

  HingedModel model_;
  HingedTree tree_;
  std::vector<Matrix3d> R_PC_at_zero_;  ///< of each hinge
  std::vector<double> state_;
  mutable std::vector<BodyWork<double>> work_;
  mutable std::vector<SoftRows<double>> soft_;
};

}  // namespace quadcore
