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

/// A vehicle's bodies and joints as bodies and hinges of an ODE world, which destroys them: bodies
/// sit at their centres of mass along their link's axes, hinges are attached as (child, parent).
class OdeVehicle {
 public:
  /// The vehicle must outlive it.
  OdeVehicle(const Bodies& vehicle, dWorldID world);

  /// One for each link.
  const std::vector<dBodyID>& bodies() const { return bodies_; }
  /// One for each joint.
  std::size_t hinges() const { return hinges_.size(); }
  /// Of the rotors, the hinges that are not locked.
  std::size_t rotors() const { return vehicle_.rotors.size(); }
  /// The hinges as ConstraintRows takes them.
  std::vector<Hinge> hinge_rows() const;

  void place(const VehicleState& state);
  /// Adds the loads, the joints' damping, and over a step of dt what prescribed rates react with,
  /// to the forces on the bodies.
  void apply(const Loads& loads, const Kinematics& kinematics, double dt);
  /// Gives joints the rates that loads prescribe, about their axes alone.
  void turn(const Loads& loads);
  /// The same as Gazebo's SetVelocity() does it: overwrites the whole velocity of each such rotor
  /// by what its carrier's is at the start of the step, so that the carrier bears nothing of what
  /// turns the rotor along with it.
  void turn_like_gazebo(const Loads& loads);
  /// <dampingFactor>: damps the velocities that a step in flight has left.
  void damp();

  /// ODE's direct solver is to report the forces of the hinges.
  void report_hinge_forces();
  /// Of the solver's last step, as reported.
  /// \param R_WC  of the child as that step began
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
