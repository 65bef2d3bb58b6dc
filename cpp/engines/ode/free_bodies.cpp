#include "free_bodies.hpp"

#include <algorithm>

#include "body_state.hpp"
#include "hinge_angle.hpp"
#include "ode_math.hpp"

namespace quadcore {
namespace {

// Gazebo's settings of ODE's auto-disabling.
constexpr double rest_time = 1;  // s
constexpr double rest_steps = 5;
constexpr double slow_speed = 0.1;  // m/s
constexpr double slow_rate = 0.1;   // rad/s

HingeKind kind_of(FreeJointKind kind) {
  switch (kind) {
    case FreeJointKind::prismatic:
      return HingeKind::prismatic;
    case FreeJointKind::universal:
      return HingeKind::universal;
    case FreeJointKind::ball:
      return HingeKind::ball;
    default:
      return HingeKind::revolute;
  }
}

bool is_locked(const FreeJoint& joint) {
  return joint.kind == FreeJointKind::fixed ||
         (joint.kind == FreeJointKind::revolute && joint.lower == joint.upper);
}

laws::Quaternion<double> orientation_of(dBodyID body) {
  if (!body) return {0, 0, 0, 1};
  const dReal* const q = dBodyGetQuaternion(body);
  return {q[1], q[2], q[3], q[0]};
}

}  // namespace

FreeBodies::FreeBodies(const World& world)
    : given_(world.free_bodies), joints_(world.free_joints), touching_(given_.size()) {
  if (given_.empty()) return;
  world_.reset(dWorldCreate());
  for (const FreeBody& given : given_) create(given);
  rest_.assign(bodies_.size(), {rest_time, rest_steps});
}

void FreeBodies::create(const FreeBody& given) {
  const Matrix3d I = given.inertial.inertia_in_link_axes();
  dMass mass;
  dMassSetParameters(&mass, given.inertial.mass, 0, 0, 0, I(0, 0), I(1, 1), I(2, 2), I(0, 1),
                     I(0, 2), I(1, 2));
  const dBodyID body = dBodyCreate(world_.get());
  dBodySetMass(body, &mass);
  dBodySetGravityMode(body, given.gravity ? 1 : 0);
  const Vector3d p = given.position_W + given.orientation_W * given.inertial.pose.xyz;
  const Quaterniond& q = given.orientation_W;
  const dQuaternion ode_q = {q.w(), q.x(), q.y(), q.z()};
  dBodySetPosition(body, p.x(), p.y(), p.z());
  dBodySetQuaternion(body, ode_q);
  const Vector3d &v = given.linear_velocity_W, &w = given.angular_velocity_W;
  dBodySetLinearVel(body, v.x(), v.y(), v.z());
  dBodySetAngularVel(body, w.x(), w.y(), w.z());
  bodies_.push_back(body);
  inertia_.push_back(I);
}

std::vector<Hinge> FreeBodies::hinge_rows(std::size_t first) const {
  std::vector<Hinge> rows;
  for (const FreeJoint& joint : joints_) {
    const bool in_world = joint.parent == FreeJoint::world;
    Hinge hinge{first + joint.child,
                in_world ? Hinge::world : first + joint.parent,
                joint.anchor_C - given_[joint.child].inertial.pose.xyz,
                joint.anchor_P,
                joint.axis_C,
                joint.axis_P};
    if (!in_world) hinge.anchor_P -= given_[joint.parent].inertial.pose.xyz;
    hinge.friction = joint.friction;
    hinge.locked = is_locked(joint);
    hinge.q_PC_at_zero = joint.q_PC_at_zero;
    hinge.kind = kind_of(joint.kind);
    hinge.lower = joint.lower;
    hinge.upper = joint.upper;
    rows.push_back(hinge);
  }
  return rows;
}

std::vector<GazeboStep::Damping> FreeBodies::damping() const {
  std::vector<GazeboStep::Damping> damping;
  for (const FreeBody& given : given_) damping.push_back({given.linear_decay, given.angular_decay});
  return damping;
}

void FreeBodies::push() const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Matrix3d R_WB = rotation(dBodyGetRotation(bodies_[i]));
    const Vector3d w_W = vec(dBodyGetAngularVel(bodies_[i]));
    const Vector3d tau_W = -w_W.cross(R_WB * (inertia_[i] * (R_WB.transpose() * w_W)));
    dBodyAddTorque(bodies_[i], tau_W.x(), tau_W.y(), tau_W.z());
  }
  for (const FreeJoint& joint : joints_) {
    if (joint.damping != 0 || joint.stiffness != 0) push_joint(joint);
  }
}

/// Add a spring and damping along the axis of a joint, both from the state before the step.
void FreeBodies::push_joint(const FreeJoint& joint) const {
  const dBodyID child = bodies_[joint.child];
  const dBodyID parent = joint.parent == FreeJoint::world ? nullptr : bodies_[joint.parent];
  const Matrix3d R_WC = rotation(dBodyGetRotation(child));
  const Vector3d axis_W = R_WC * joint.axis_C;
  const Vector3d arm_C_W = R_WC * (joint.anchor_C - given_[joint.child].inertial.pose.xyz);
  const Vector3d at_W = vec(dBodyGetPosition(child)) + arm_C_W;
  dVector3 velocity = {0, 0, 0};
  Vector3d anchor_P_W = joint.anchor_P, w_P_W = Vector3d::Zero();
  if (parent) {
    const Vector3d arm_P = joint.anchor_P - given_[joint.parent].inertial.pose.xyz;
    anchor_P_W = vec(dBodyGetPosition(parent)) + rotation(dBodyGetRotation(parent)) * arm_P;
    dBodyGetPointVel(parent, at_W.x(), at_W.y(), at_W.z(), velocity);
    w_P_W = vec(dBodyGetAngularVel(parent));
  }
  if (joint.kind == FreeJointKind::prismatic) {
    const Vector3d v_W =
        vec(dBodyGetLinearVel(child)) + vec(dBodyGetAngularVel(child)).cross(arm_C_W);
    const double rate = axis_W.dot(v_W - Vector3d(velocity[0], velocity[1], velocity[2]));
    const double position = axis_W.dot(at_W - anchor_P_W);
    const double force = -joint.damping * rate - joint.stiffness * (position - joint.rest_position);
    const Vector3d f = force * axis_W;
    dBodyAddForceAtPos(child, f.x(), f.y(), f.z(), at_W.x(), at_W.y(), at_W.z());
    if (parent) dBodyAddForceAtPos(parent, -f.x(), -f.y(), -f.z(), at_W.x(), at_W.y(), at_W.z());
    return;
  }
  const Quaterniond& q = joint.q_PC_at_zero;
  const double angle =
      hinge_angle(orientation_of(child), orientation_of(parent), {q.x(), q.y(), q.z(), q.w()},
                  {joint.axis_C.x(), joint.axis_C.y(), joint.axis_C.z()});
  const double rate = axis_W.dot(vec(dBodyGetAngularVel(child)) - w_P_W);
  const Vector3d t =
      (-joint.damping * rate - joint.stiffness * (angle - joint.rest_position)) * axis_W;
  dBodyAddTorque(child, t.x(), t.y(), t.z());
  if (parent) dBodyAddTorque(parent, -t.x(), -t.y(), -t.z());
}

void FreeBodies::put_to_sleep(const std::vector<Contact>& contacts, double dt, std::size_t first,
                              std::vector<char>& asleep) {
  std::fill(touching_.begin(), touching_.end(), 0);
  for (const Contact& contact : contacts) {
    if (contact.body >= first) touching_[contact.body - first] = 1;
    if (contact.other >= static_cast<int>(first)) {
      touching_[static_cast<std::size_t>(contact.other) - first] = 1;
    }
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!given_[i].may_sleep || !touching_[i] || asleep[first + i]) continue;
    const bool is_slow =
        vec(dBodyGetLinearVel(bodies_[i])).squaredNorm() <= slow_speed * slow_speed &&
        vec(dBodyGetAngularVel(bodies_[i])).squaredNorm() <= slow_rate * slow_rate;
    Rest& rest = rest_[i];
    rest = is_slow ? Rest{rest.time - dt, rest.steps - 1} : Rest{rest_time, rest_steps};
    if (rest.time > 0 || rest.steps > 0) continue;
    asleep[first + i] = 1;
    dBodySetLinearVel(bodies_[i], 0, 0, 0);
    dBodySetAngularVel(bodies_[i], 0, 0, 0);
  }
}

std::vector<FreeBodyState> FreeBodies::states() const {
  std::vector<FreeBodyState> states;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const dReal* const q = dBodyGetQuaternion(bodies_[i]);
    const Quaterniond q_W(q[0], q[1], q[2], q[3]);
    const Vector3d arm_W = q_W * -given_[i].inertial.pose.xyz;
    const Vector3d w_W = vec(dBodyGetAngularVel(bodies_[i]));
    states.push_back({given_[i].model + "::" + given_[i].name,
                      vec(dBodyGetPosition(bodies_[i])) + arm_W, q_W,
                      vec(dBodyGetLinearVel(bodies_[i])) + w_W.cross(arm_W), w_W});
  }
  return states;
}

constexpr std::size_t rest_size = 2;

std::size_t FreeBodies::saved_size() const {
  return bodies_.size() * (pose_size + velocity_size + rest_size);
}

double* FreeBodies::save(double* to) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    save_pose(bodies_[i], to);
    save_velocity(bodies_[i], to + pose_size);
    to += pose_size + velocity_size;
    *to++ = rest_[i].time;
    *to++ = rest_[i].steps;
  }
  return to;
}

const double* FreeBodies::restore(const double* from) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    forget_forces(bodies_[i]);
    restore_pose(bodies_[i], from);
    restore_velocity(bodies_[i], from + pose_size);
    from += pose_size + velocity_size;
    rest_[i] = {from[0], from[1]};
    from += rest_size;
  }
  return from;
}

}  // namespace quadcore
