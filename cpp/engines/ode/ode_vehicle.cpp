#include "ode_vehicle.hpp"

#include "body_damping.hpp"
#include "body_state.hpp"
#include "ode_math.hpp"

namespace quadcore {
namespace {

double implicit_damping(const Joint& joint) { return joint.implicit_damping ? joint.damping : 0; }

}  // namespace

OdeVehicle::OdeVehicle(const Bodies& vehicle, dWorldID world)
    : vehicle_(vehicle), model_(vehicle.model) {
  create_bodies(world);
  create_hinges(world);
}

void OdeVehicle::create_bodies(dWorldID world) {
  const std::vector<Eigen::Isometry3d> poses = link_poses(model_);
  for (std::size_t i = 0; i < model_.links.size(); ++i) {
    const Inertial& inertial = model_.links[i].inertial;
    const Matrix3d I = inertial.inertia_in_link_axes();
    dMass mass;
    dMassSetParameters(&mass, inertial.mass, 0, 0, 0, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2),
                       I(1, 2));
    const dBodyID body = dBodyCreate(world);
    dBodySetMass(body, &mass);
    dBodySetGyroscopicMode(body, 0);
    dBodySetGravityMode(body, model_.links[i].tags.gravity ? 1 : 0);
    bodies_.push_back(body);
    place(i, poses[i], Vector3d::Zero(), Vector3d::Zero());
  }
}

void OdeVehicle::create_hinges(dWorldID world) {
  const std::vector<Eigen::Isometry3d> poses = link_poses(model_);
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    const Joint& joint = model_.joints[i];
    const Eigen::Isometry3d& pose = poses[i + 1];
    const Vector3d anchor = pose.translation();
    const Vector3d axis = pose.linear() * joint.axis;
    const dJointID hinge = dJointCreateHinge(world, nullptr);
    dJointAttach(hinge, bodies_[i + 1], bodies_[joint.parent]);
    dJointSetHingeAnchor(hinge, anchor.x(), anchor.y(), anchor.z());
    dJointSetHingeAxis(hinge, axis.x(), axis.y(), axis.z());
    if (vehicle_.is_locked(i)) {
      dJointSetHingeParam(hinge, dParamLoStop, 0);
      dJointSetHingeParam(hinge, dParamHiStop, 0);
    } else if (const double damping = implicit_damping(joint);
               damping > 0) {  // a stop on either side of the joint's position
      dJointSetHingeParam(hinge, dParamLoStop, 0);
      dJointSetHingeParam(hinge, dParamHiStop, 0);
      dJointSetHingeParam(hinge, dParamStopERP, 0);
      dJointSetHingeParam(hinge, dParamStopCFM, 1 / damping);
    } else {
      dJointSetHingeParam(hinge, dParamVel, 0);
      dJointSetHingeParam(hinge, dParamFMax, joint.friction);
    }
    hinges_.push_back(hinge);
  }
}

std::vector<Hinge> OdeVehicle::hinge_rows() const {
  std::vector<Hinge> rows;
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    const Joint& joint = model_.joints[i];
    const Vector3d& c_C = model_.links[i + 1].inertial.pose.xyz;
    const Vector3d& c_P = model_.links[joint.parent].inertial.pose.xyz;
    rows.push_back({i + 1, joint.parent, -c_C, joint.pose.xyz - c_P, joint.axis,
                    joint.pose.rotation() * joint.axis, joint.friction, implicit_damping(joint),
                    vehicle_.is_locked(i), joint.pose.rotation()});
  }
  return rows;
}

void OdeVehicle::report_hinge_forces() {
  feedback_.resize(hinges_.size());
  for (std::size_t i = 0; i < hinges_.size(); ++i) dJointSetFeedback(hinges_[i], &feedback_[i]);
}

GazeboStep::Multipliers OdeVehicle::multipliers(std::size_t hinge, const Matrix3d& R_WC) const {
  const Vector3d f_W = vec(feedback_[hinge].f1);
  const Vector3d anchor_W = R_WC * -model_.links[hinge + 1].inertial.pose.xyz;
  const Vector3d tau_W = vec(feedback_[hinge].t1) - anchor_W.cross(f_W);
  const Vector3d axis_W = R_WC * model_.joints[hinge].axis;
  const auto across_W = plane_space(axis_W);
  return {f_W.x(),          f_W.y(), f_W.z(), tau_W.dot(across_W[0]), tau_W.dot(across_W[1]),
          tau_W.dot(axis_W)};
}

void OdeVehicle::place(std::size_t link, const Eigen::Isometry3d& X_WL, const Vector3d& v_WL_W,
                       const Vector3d& w_WL_W) {
  const Vector3d p_LLcm_W = X_WL.linear() * model_.links[link].inertial.pose.xyz;
  const Vector3d p = X_WL.translation() + p_LLcm_W;
  const Vector3d v = v_WL_W + w_WL_W.cross(p_LLcm_W);
  const Quaterniond q(X_WL.linear());
  const dQuaternion ode_q = {q.w(), q.x(), q.y(), q.z()};
  const dBodyID body = bodies_[link];
  forget_forces(body);
  dBodySetPosition(body, p.x(), p.y(), p.z());
  dBodySetQuaternion(body, ode_q);
  dBodySetLinearVel(body, v.x(), v.y(), v.z());
  dBodySetAngularVel(body, w_WL_W.x(), w_WL_W.y(), w_WL_W.z());
}

void OdeVehicle::place(const VehicleState& state) {
  std::vector<Eigen::Isometry3d> X_WL(model_.links.size());
  std::vector<Vector3d> v_W(model_.links.size()), w_W(model_.links.size());
  const Quaterniond q = state.orientation.normalized();
  X_WL[0] = Eigen::Translation3d(state.position) * q;
  v_W[0] = state.linear_velocity;
  w_W[0] = q * state.angular_velocity;
  Eigen::Index rotor = 0;
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    const Joint& joint = model_.joints[i];
    const bool locked = vehicle_.is_locked(i);
    const double angle = locked ? 0 : state.rotor_angle[rotor];
    const double rate = locked ? 0 : state.rotor_velocity[rotor++];
    const std::size_t parent = joint.parent, child = i + 1;
    X_WL[child] = X_WL[parent] * Eigen::Translation3d(joint.pose.xyz) * joint.pose.rotation() *
                  quaternion_about(joint.axis, angle);
    const Vector3d arm_W = X_WL[child].translation() - X_WL[parent].translation();
    v_W[child] = v_W[parent] + w_W[parent].cross(arm_W);
    w_W[child] = w_W[parent] + X_WL[child].linear() * joint.axis * rate;
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) place(i, X_WL[i], v_W[i], w_W[i]);
}

void OdeVehicle::apply(const Loads& loads, const Kinematics& k, double dt) {
  const Matrix3d& R_WF = k.R_WF;
  const Wrench frame = loads.frame();
  const Vector3d f_W = R_WF * frame.force_F;
  const Vector3d tau_Fcm_W =
      R_WF * (frame.torque_F - model_.links[0].inertial.pose.xyz.cross(frame.force_F));
  dBodyAddForce(bodies_[0], f_W.x(), f_W.y(), f_W.z());
  dBodyAddTorque(bodies_[0], tau_Fcm_W.x(), tau_Fcm_W.y(), tau_Fcm_W.z());
  for (std::size_t i = 0; i < rotors(); ++i) {
    const std::size_t hinge = vehicle_.rotors[i];
    const Vector3d f_R_W = R_WF * loads.rotor_force_F(i);
    dBodyAddForce(bodies_[hinge + 1], f_R_W.x(), f_R_W.y(), f_R_W.z());
    const Joint& joint = model_.joints[hinge];
    if (const auto& rate = loads.joint_rate(i)) {
      if (!rate->reacts) continue;
      const Vector3d tau_W = moment_about_joint(model_, hinge) *
                             (k.rotors.number(MotionRow::rate, i) - rate->at_end) / dt *
                             (R_WF * k.rotors.vector(MotionRow::axis, i));
      dBodyAddTorque(bodies_[joint.parent], tau_W.x(), tau_W.y(), tau_W.z());
      continue;
    }
    const double damping = joint.implicit_damping ? 0 : -joint.damping * k.rotors[i].rate;
    dJointAddHingeTorque(hinges_[hinge], damping + loads.joint_torque(i));
  }
}

void OdeVehicle::turn(const Loads& loads) {
  for (std::size_t i = 0; i < rotors(); ++i) {
    const auto& rate = loads.joint_rate(i);
    if (!rate) continue;
    const std::size_t hinge = vehicle_.rotors[i];
    const dBodyID child = bodies_[hinge + 1], parent = bodies_[model_.joints[hinge].parent];
    const Matrix3d R_WC = rotation(dBodyGetRotation(child));
    const Vector3d axis_W = R_WC * model_.joints[hinge].axis;
    const Vector3d w_WC_W = vec(dBodyGetAngularVel(child)), v_WC_W = vec(dBodyGetLinearVel(child));
    const double now = axis_W.dot(w_WC_W - vec(dBodyGetAngularVel(parent)));
    const Vector3d more_W = (rate->at_end - now) * axis_W;
    const Vector3d w_W = w_WC_W + more_W;
    const Vector3d v_W = v_WC_W + more_W.cross(R_WC * model_.links[hinge + 1].inertial.pose.xyz);
    dBodySetLinearVel(child, v_W.x(), v_W.y(), v_W.z());
    dBodySetAngularVel(child, w_W.x(), w_W.y(), w_W.z());
  }
}

void OdeVehicle::turn_like_gazebo(const Loads& loads) {
  for (std::size_t i = 0; i < rotors(); ++i) {
    const auto& rate = loads.joint_rate(i);
    if (!rate) continue;
    const std::size_t hinge = vehicle_.rotors[i];
    const Joint& joint = model_.joints[hinge];
    const dBodyID child = bodies_[hinge + 1], parent = bodies_[joint.parent];
    const Matrix3d R_WC = rotation(dBodyGetRotation(child));
    const Matrix3d R_WP = rotation(dBodyGetRotation(parent));
    const Vector3d w_WP_W = vec(dBodyGetAngularVel(parent));
    const Vector3d w_W = w_WP_W + rate->at_end * (R_WC * joint.axis);
    // Each body has its own anchor, and a step leaves a gap between them.
    const Vector3d arm_P_W = R_WP * (joint.pose.xyz - model_.links[joint.parent].inertial.pose.xyz);
    const Vector3d arm_C_W = R_WC * model_.links[hinge + 1].inertial.pose.xyz;
    const Vector3d v_W =
        vec(dBodyGetLinearVel(parent)) + w_WP_W.cross(arm_P_W) + w_W.cross(arm_C_W);
    dBodySetLinearVel(child, v_W.x(), v_W.y(), v_W.z());
    dBodySetAngularVel(child, w_W.x(), w_W.y(), w_W.z());
  }
}

void OdeVehicle::damp() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const double factor = model_.links[i].tags.damping_factor;
    if (factor == 0) continue;
    const Vector3d v = vec(dBodyGetLinearVel(bodies_[i])), w = vec(dBodyGetAngularVel(bodies_[i]));
    const double keep_v = part_left_by_damping(v, factor);
    const double keep_w = part_left_by_damping(w, factor);
    dBodySetLinearVel(bodies_[i], keep_v * v.x(), keep_v * v.y(), keep_v * v.z());
    dBodySetAngularVel(bodies_[i], keep_w * w.x(), keep_w * w.y(), keep_w * w.z());
  }
}

}  // namespace quadcore
