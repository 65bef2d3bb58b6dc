#pragma once

#include <ode/ode.h>

#include <vector>

#include "bodies.hpp"
#include "constraint_rows.hpp"
#include "gazebo_step.hpp"
#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/plugin/loads.hpp"
#include "quadcore/state.hpp"

namespace quadcore {

/// A vehicle's bodies and joints as bodies and hinges of an ODE world, which destroys them. Bodies
/// are at their centres of mass with their link's axes, and hinges are attached as (child, parent).
class OdeVehicle {
 public:
  /// The vehicle must outlive this object.
  OdeVehicle(const Bodies& vehicle, dWorldID world);

  /// Return the bodies, one for each link.
  const std::vector<dBodyID>& bodies() const { return bodies_; }
  /// Return the hinges, one for each joint.
  std::size_t hinges() const { return hinges_.size(); }
  /// Return the hinges of the rotors, which are not locked.
  std::size_t rotors() const { return vehicle_.rotors.size(); }
  /// Return the hinges for ConstraintRows.
  std::vector<Hinge> hinge_rows() const;

  void place(const VehicleState& state);
  /// Add the loads, the joints' damping, and the reactions of prescribed rates over a step of dt to
  /// the forces on the bodies.
  void apply(const Loads& loads, const Kinematics& kinematics, double dt);
  /// Set the prescribed rates of joints, only about their axes.
  void turn(const Loads& loads);
  /// Set the rates like Gazebo's SetVelocity(): overwrite the whole velocity of each such rotor
  /// with that of its carrier at the start of the step. The carrier therefore does not take the
  /// reaction of turning the rotor along.
  void turn_like_gazebo(const Loads& loads);
  /// Apply <dampingFactor> to the velocities after a step in flight.
  void damp();

  /// Let ODE's direct solver report the forces of the hinges.
  void report_hinge_forces();
  /// Return the reported load of a hinge in the solver's last step.
  /// \param R_WC  orientation of the child at the start of that step
  GazeboStep::Multipliers multipliers(std::size_t hinge, const Matrix3d& R_WC) const;

 private:
  void create_bodies(dWorldID world);
  void create_hinges(dWorldID world);
  void place(std::size_t link, const Eigen::Isometry3d& X_WL, const Vector3d& v_WL_W,
             const Vector3d& w_WL_W);

  const Bodies& vehicle_;
  const Model& model_;
  std::vector<dBodyID> bodies_;
  std::vector<dJointID> hinges_;
  std::vector<dJointFeedback> feedback_;
};

}  // namespace quadcore
