#include "articulated_step.hpp"

#include "body_state.hpp"
#include "ode_math.hpp"

namespace quadcore {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = ConstraintRow::Vector6;

Spatial operator+(const Spatial& a, const Spatial& b) {
  return {a.linear + b.linear, a.angular + b.angular};
}

Spatial operator-(const Spatial& a, const Spatial& b) {
  return {a.linear - b.linear, a.angular - b.angular};
}

Spatial operator*(double factor, const Spatial& a) {
  return {factor * a.linear, factor * a.angular};
}

/// An acceleration times a load.
double dot(const Spatial& a, const Spatial& b) {
  return a.linear.dot(b.linear) + a.angular.dot(b.angular);
}

SpatialInertia& operator+=(SpatialInertia& sum, const SpatialInertia& I) {
  sum.mass += I.mass;
  sum.coupling += I.coupling;
  sum.inertia += I.inertia;
  return sum;
}

Spatial operator*(const SpatialInertia& I, const Spatial& a) {
  return {I.mass * a.linear + I.coupling * a.angular,
          I.coupling.transpose() * a.linear + I.inertia * a.angular};
}

/// Acceleration under a load.
Spatial solve(const SpatialInertia& I, const Spatial& load) {
  const Matrix3d inverse_mass = I.mass.inverse();
  const Matrix3d lever = I.coupling.transpose() * inverse_mass;
  Spatial a;
  a.angular = (I.inertia - lever * I.coupling).inverse() * (load.angular - lever * load.linear);
  a.linear = inverse_mass * (load.linear - I.coupling * a.angular);
  return a;
}

Matrix6 matrix(const SpatialInertia& I) {
  Matrix6 m;
  m << I.mass, I.coupling, I.coupling.transpose(), I.inertia;
  return m;
}

SpatialInertia inertia_of(const Matrix6& m) {
  return {m.topLeftCorner<3, 3>(), m.topRightCorner<3, 3>(), m.bottomRightCorner<3, 3>()};
}

Vector6 column(const Spatial& a) { return (Vector6() << a.linear, a.angular).finished(); }

Spatial spatial(const Vector6& column) { return {column.head<3>(), column.tail<3>()}; }

/// Acceleration at O with which a hinge at A gives way to a unit of load, but about its axis.
Matrix6 compliance(double softness, const Vector3d& p_OA_W, const Vector3d& axis_W) {
  const Matrix3d arm = skew(p_OA_W);
  const Matrix3d across = softness * (Matrix3d::Identity() - axis_W * axis_W.transpose());
  Matrix6 m;
  m << softness * Matrix3d::Identity() - arm * across * arm, arm * across, -across * arm, across;
  return m;
}

}  // namespace

ArticulatedStep::ArticulatedStep(const std::vector<dBodyID>& bodies,
                                 const std::vector<Hinge>& hinges, const Options& options)
    : ode_bodies_(bodies), options_(options), bodies_(bodies.size()), links_(hinges.size()) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    dMass mass;
    dBodyGetMass(bodies[i], &mass);
    bodies_[i].mass = mass.mass;
    bodies_[i].I_Bcm_B = rotation(mass.I);
    bodies_[i].gravity = dBodyGetGravityMode(bodies[i]) != 0;
    bodies_[i].carries = false;
  }
  for (std::size_t i = 0; i < hinges.size(); ++i) {
    links_[i].hinge = hinges[i];
    bodies_[hinges[i].parent].carries = true;
  }
}

void ArticulatedStep::step(double dt) {
  read_bodies();
  for (Link& link : links_) read_hinge(link, dt);
  for (Body& body : bodies_) find_forces(body);
  for (std::size_t i = links_.size(); i-- > 0;) eliminate(links_[i], dt);
  accelerate(dt);
  move(dt);
}

void ArticulatedStep::read_bodies() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const dBodyID ode = ode_bodies_[i];
    Body& body = bodies_[i];
    body.p_W = vec(dBodyGetPosition(ode));
    body.R_WB = rotation(dBodyGetRotation(ode));
    body.I_Bcm_W = body.R_WB * body.I_Bcm_B * body.R_WB.transpose();
    body.velocity << vec(dBodyGetLinearVel(ode)), vec(dBodyGetAngularVel(ode));
    body.force = {vec(dBodyGetForce(ode)), vec(dBodyGetTorque(ode))};
    if (body.carries) body.carried = SpatialInertia{};
  }
  bodies_[0].p_OBcm_W.setZero();
}

void ArticulatedStep::read_hinge(Link& link, double dt) {
  Body& child = bodies_[link.hinge.child];
  const Body& parent = bodies_[link.hinge.parent];
  const HingePlace place(link.hinge, child.p_W, child.R_WB, parent.p_W, parent.R_WB);
  link.axis_W = place.axis_W;
  link.p_OA_W = parent.p_OBcm_W + place.anchor_P_W;
  child.p_OBcm_W = link.p_OA_W - place.anchor_C_W;
  const Vector3d w_WC_W = child.velocity.tail<3>(), w_WP_W = parent.velocity.tail<3>();
  const Vector3d slip_W = child.velocity.head<3>() + w_WC_W.cross(place.anchor_C_W) -
                          (parent.velocity.head<3>() + w_WP_W.cross(place.anchor_P_W));
  const Vector3d turn_W = w_WC_W - w_WP_W;
  link.rate = link.axis_W.dot(turn_W);
  const double rate = options_.erp / dt;
  link.wanted.angular = (rate * place.tilt_W - (turn_W - link.rate * link.axis_W)) / dt;
  link.wanted.linear = (rate * place.gap_W - slip_W) / dt + link.p_OA_W.cross(link.wanted.angular);
  link.turn = {link.p_OA_W.cross(link.axis_W), link.axis_W};
}

/// Moves the forces on a body to O.
void ArticulatedStep::find_forces(Body& body) const {
  if (body.gravity) body.force.linear += body.mass * options_.gravity_W;
  body.force.angular += body.p_OBcm_W.cross(body.force.linear);
}

/// What an acceleration asks for of a body and of what it carries.
Spatial ArticulatedStep::load(const Body& body, const Spatial& a) {
  const Vector3d f_W = body.mass * (a.linear + a.angular.cross(body.p_OBcm_W));
  const Spatial alone{f_W, body.I_Bcm_W * a.angular + body.p_OBcm_W.cross(f_W)};
  return body.carries ? alone + body.carried * a : alone;
}

/// The same for every acceleration.
SpatialInertia ArticulatedStep::inertia(const Body& body) {
  const double m = body.mass;
  const Vector3d& p = body.p_OBcm_W;
  SpatialInertia sum{
      m * Matrix3d::Identity(), -skew(m * p),
      body.I_Bcm_W + m * (p.squaredNorm() * Matrix3d::Identity() - p * p.transpose())};
  return body.carries ? sum += body.carried : sum;
}

void ArticulatedStep::eliminate(Link& link, double dt) {
  const Body& child = bodies_[link.hinge.child];
  Body& parent = bodies_[link.hinge.parent];
  SpatialInertia felt = inertia(child);
  Spatial force = child.force, load_of_wanted;
  if (options_.cfm > 0) {  // what the parent feels of the child through a hinge that gives way
    const Matrix6 I = matrix(felt);
    const Eigen::PartialPivLU<Matrix6> softened(
        Matrix6::Identity() + I * compliance(options_.cfm / dt, link.p_OA_W, link.axis_W));
    felt = inertia_of(softened.solve(I));
    force = spatial(softened.solve(column(force)));
    link.load_of_turn = felt * link.turn;
    load_of_wanted = felt * link.wanted;
  } else {
    link.load_of_turn = load(child, link.turn);
    load_of_wanted = load(child, link.wanted);
  }
  const double moment = dot(link.turn, link.load_of_turn), torque = dot(link.turn, force);
  if (link.hinge.implicit_damping > 0) {
    // At the end of the step, rate + torque of the hinge/damping = 0.
    const double softness = 1 / (link.hinge.implicit_damping * dt);
    link.give = softness / (1 + softness * moment);
    link.spin = link.give * torque - link.rate / dt / (1 + softness * moment);
  } else {
    link.give = 1 / moment;
    link.spin = link.give * torque;
  }
  const double turn = link.spin - link.give * dot(link.wanted, link.load_of_turn);
  parent.force = parent.force + (force - (load_of_wanted + turn * link.load_of_turn));
  const Vector3d &f_W = link.load_of_turn.linear, &tau_W = link.load_of_turn.angular;
  const Vector3d gives_f_W = link.give * f_W, gives_tau_W = link.give * tau_W;
  felt.mass -= gives_f_W * f_W.transpose();
  felt.coupling -= gives_f_W * tau_W.transpose();
  felt.inertia -= gives_tau_W * tau_W.transpose();
  parent.carried += felt;
}

void ArticulatedStep::accelerate(double dt) {
  bodies_[0].acceleration = solve(inertia(bodies_[0]), bodies_[0].force);
  for (const Link& link : links_) {
    Body& child = bodies_[link.hinge.child];
    Spatial a = bodies_[link.hinge.parent].acceleration + link.wanted;
    a = a + (link.spin - link.give * dot(a, link.load_of_turn)) * link.turn;
    if (options_.cfm > 0) {
      const Matrix6 give = compliance(options_.cfm / dt, link.p_OA_W, link.axis_W);
      const Matrix6 felt = Matrix6::Identity() + give * matrix(inertia(child));
      a = spatial(felt.partialPivLu().solve(column(a) + give * column(child.force)));
    }
    child.acceleration = a;
  }
}

void ArticulatedStep::move(double dt) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    const Spatial& a = body.acceleration;
    body.velocity.head<3>() += dt * (a.linear + a.angular.cross(body.p_OBcm_W));
    body.velocity.tail<3>() += dt * a.angular;
    move_pose(ode_bodies_[i], body.velocity.head<3>(), body.velocity.tail<3>(), dt);
    restore_velocity(ode_bodies_[i], body.velocity.data());
    forget_forces(ode_bodies_[i]);
  }
}

GazeboStep::Multipliers ArticulatedStep::multipliers(std::size_t hinge) const {
  const Link& link = links_[hinge];
  const Body& child = bodies_[link.hinge.child];
  const Spatial exerted = load(child, child.acceleration) - child.force;
  const Vector3d& f_W = exerted.linear;
  const Vector3d tau_W = exerted.angular - link.p_OA_W.cross(f_W);
  const auto across_W = plane_space(link.axis_W);
  return {f_W.x(),
          f_W.y(),
          f_W.z(),
          tau_W.dot(across_W[0]),
          tau_W.dot(across_W[1]),
          tau_W.dot(link.axis_W)};
}

}  // namespace quadcore
