#pragma once

#include <ode/ode.h>

#include <vector>

#include "constraint_rows.hpp"
#include "gazebo_step.hpp"

namespace quadcore {

/// Two vectors in W that belong together at a point O: the acceleration there of whatever moves
/// with a body and its angular acceleration, or a force and its torque about O.
struct Spatial {
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
};

/// The load that an acceleration asks for, both at O:
///   force = mass a + coupling alpha, torque = coupling^T a + inertia alpha.
struct SpatialInertia {
  Matrix3d mass = Matrix3d::Zero(), coupling = Matrix3d::Zero(), inertia = Matrix3d::Zero();
};

/// A step as ODE's direct solver (dWorldStep) takes it, in time linear in the number of bodies.
/// ODE asks of the accelerations a and the multipliers l
///   M a = f + J^T l,   J a + (cfm/dt) l = (ERP/dt error - J v)/dt,
/// and moves with the velocities at the end of the step. On hinges that form a tree, a child's
/// acceleration is its parent's, and what its hinge's rows ask for beyond that, and some turn about
/// the axis, which no row resists. Each child, from the leaves on, hands its parent the inertia and
/// the force of which that turn is eliminated (R. Featherstone, "Rigid Body Dynamics Algorithms",
/// 2008, ch. 7), instead of all multipliers being solved for at once. The rows are those of
/// ConstraintRows; dry friction, whose bounds are inequalities, is not among them.
class ArticulatedStep {
 public:
  struct Options {
    Vector3d gravity_W;
    double erp, cfm;
  };

  /// hinges[i] carries bodies[i + 1], on a body before that.
  ArticulatedStep(const std::vector<dBodyID>& bodies, const std::vector<Hinge>& hinges,
                  const Options& options);

  /// Advances the bodies by dt under the forces that have been added to them.
  void step(double dt);

  /// Of the last step.
  GazeboStep::Multipliers multipliers(std::size_t hinge) const;

 private:
  using Vector6 = ConstraintRow::Vector6;

  /// Vectors in W. O is where the frame's centre of mass is, and other places follow from the arms
  /// of the hinges: as in ODE's rows, no gap of a hinge lengthens them.
  struct Body {
    double mass;
    Matrix3d I_Bcm_B;
    bool gravity, carries;
    Vector3d p_W, p_OBcm_W;
    Matrix3d R_WB, I_Bcm_W;
    Vector6 velocity;        ///< linear, angular
    SpatialInertia carried;  ///< with which it resists for what it carries
    Spatial force;           ///< on it and on what it carries
    Spatial acceleration;
  };
  struct Link {
    Hinge hinge;
    Vector3d axis_W, p_OA_W;  ///< of the anchor
    Spatial wanted;           ///< acceleration beyond the parent's
    Spatial turn;             ///< acceleration by a unit of turn about the axis
    Spatial load_of_turn;     ///< what that asks for
    double rate;              ///< about the axis [rad/s]
    double spin, give;        ///< turn: spin - give (load_of_turn . acceleration without it)
  };

  static SpatialInertia inertia(const Body& body);
  static Spatial load(const Body& body, const Spatial& acceleration);
  void read_bodies();
  void read_hinge(Link& link, double dt);
  void find_forces(Body& body) const;
  void eliminate(Link& link, double dt);
  void accelerate(double dt);
  void move(double dt);

  const std::vector<dBodyID>& ode_bodies_;
  Options options_;
  std::vector<Body> bodies_;
  std::vector<Link> links_;
};

}  // namespace quadcore
