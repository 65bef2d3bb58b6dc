#include "hinged_vehicle.hpp"

#include <algorithm>

#include "body_state.hpp"
#include "hinged_motion.hpp"
#include "ode_math.hpp"

namespace quadcore {
namespace {

Vec3<double> components(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Vector3d vector(const Vec3<double>& v) { return {v.x, v.y, v.z}; }

}  // namespace

HingedModel::HingedModel(const Model& model)
    : carriers(model.links.size()),
      carries(model.links.size()),
      brakes(model.links.size()),
      constants(model.links.size() * BodyConstant::count) {
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    using Row = BodyConstant;
    double* const rows = &constants[i * Row::count];
    const auto put = [rows](std::size_t row, const Vector3d& v) {
      std::copy_n(v.data(), 3, rows + row);
    };
    const Link& link = model.links[i];
    rows[Row::mass] = link.inertial.mass;
    rows[Row::weight] = link.tags.gravity ? link.inertial.mass : 0;
    const Matrix3d I = link.inertial.inertia_in_link_axes();
    put(Row::inertia, {I(0, 0), I(0, 1), I(0, 2)});
    put(Row::inertia + 3, {I(1, 1), I(1, 2), I(2, 2)});
    put(Row::origin, -link.inertial.pose.xyz);
    if (i == 0) continue;
    const Joint& joint = model.joints[i - 1];
    put(Row::anchor_P, joint.pose.xyz - model.links[joint.parent].inertial.pose.xyz);
    put(Row::axis_C, joint.axis);
    put(Row::axis_P, joint.pose.rotation() * joint.axis);
    rows[joint.implicit_damping ? Row::implicit_damping : Row::damping] = joint.damping;
    const auto across_C = plane_space(joint.axis);
    put(Row::across_C, across_C[0]);
    put(Row::across_C + 3, across_C[1]);
    carriers[i] = joint.parent;
    carries[joint.parent] = true;
    brakes[i] = rows[Row::implicit_damping] > 0;
  }
}

HingedTree HingedModel::tree(const World& world) const {
  const Vector3d& g_W = world.gravity_W;
  return {carriers.size(), carriers.data(),          carries.data(), brakes.data(),
          {g_W.x(), g_W.y(), g_W.z()}, world.erp, world.cfm};
}

HingedVehicle::HingedVehicle(const Model& model, const World& world)
    : model_(model),
      tree_(model_.tree(world)),
      state_(model.links.size() * BodyRow::count),
      work_(model.links.size()),
      soft_(world.cfm > 0 ? model.links.size() : 0) {
  for (const Joint& joint : model.joints) {
    R_PC_at_zero_.push_back(joint.pose.rotation().toRotationMatrix());
  }
}

HingedVehicle::Bodies HingedVehicle::bodies() const {
  return {tree_, model_.constants.data(), const_cast<double*>(state_.data()), work_.data(),
          soft_.empty() ? nullptr : soft_.data()};
}

void HingedVehicle::take(const std::vector<dBodyID>& bodies) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    double* const rows = &state_[i * BodyRow::count];
    const dReal* const q = dBodyGetQuaternion(bodies[i]);
    std::copy_n(dBodyGetPosition(bodies[i]), 3, rows + BodyRow::position);
    std::copy_n(q + 1, 3, rows + BodyRow::orientation);
    rows[BodyRow::orientation + 3] = q[0];
    std::copy_n(dBodyGetLinearVel(bodies[i]), 3, rows + BodyRow::velocity);
    std::copy_n(dBodyGetAngularVel(bodies[i]), 3, rows + BodyRow::rate);
  }
  this->bodies().read();
}

void HingedVehicle::take_forces(const std::vector<dBodyID>& bodies) {
  this->bodies().clear_forces();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    work_[i].force = {components(vec(dBodyGetForce(bodies[i]))),
                      components(vec(dBodyGetTorque(bodies[i])))};
  }
}

void HingedVehicle::give(const std::vector<dBodyID>& bodies) const {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const double* const rows = &state_[i * BodyRow::count];
    const double* const q = rows + BodyRow::orientation;
    const Matrix3<double>& R = work_[i].R_WB;
    double pose[pose_size] = {rows[0], rows[1], rows[2], q[3], q[0], q[1], q[2],
                              R.xx,    R.xy,    R.xz,    0,    R.yx, R.yy, R.yz,
                              0,       R.zx,    R.zy,    R.zz, 0};
    restore_pose(bodies[i], pose);
    restore_velocity(bodies[i], rows + BodyRow::velocity);
    forget_forces(bodies[i]);
  }
}

void HingedVehicle::push(const Loads& loads) {
  Bodies bodies = this->bodies();
  bodies.clear_forces();
  const HingedFrame<double> frame(bodies);
  const Wrench on_frame = loads.frame();
  push_frame(bodies, frame, components(on_frame.force_F), components(on_frame.torque_F));
  for (std::size_t i = 0; i + 1 < bodies.size(); ++i) {
    push_rotor(bodies, frame, i, components(loads.rotor_force_F(i)), loads.joint_torque(i),
               bodies.joint_rate(i + 1));
  }
}

void HingedVehicle::advance(double dt, bool gyroscopic) {
  Bodies bodies = this->bodies();
  bodies.turn_inertias(gyroscopic);
  bodies.advance(dt);
  bodies.read();
}

void HingedVehicle::show(Kinematics& k) const {
  const Bodies bodies = this->bodies();
  const HingedFrame<double> frame(bodies);
  const Matrix3<double>& R = frame.R_WF;
  const double* const q = &state_[BodyRow::orientation];
  k.q_WF = Quaterniond(q[3], q[0], q[1], q[2]);
  k.R_WF << R.xx, R.xy, R.xz, R.yx, R.yy, R.yz, R.zx, R.zy, R.zz;
  k.w_WF_F = vector(frame.w_WF_F);
  k.v_WF_F = vector(frame.v_WF_F);
  k.p_WF = vector(frame.p_WF);
  for (std::size_t i = 0; i < k.rotors.size(); ++i) {
    const HingedRotor<double, 1> rotor{bodies, frame, i};
    double* const to = k.rotors.data() + rotor_offset(MotionRow::count, i);
    const auto put = [to](std::size_t row, const Vec3<double>& v) {
      to[row * widest_lanes] = v.x;
      to[(row + 1) * widest_lanes] = v.y;
      to[(row + 2) * widest_lanes] = v.z;
    };
    const Vec3<double> z_F = rotor.normal_F();
    put(MotionRow::axis, rotor.axis_F());
    put(MotionRow::normal, z_F);
    put(MotionRow::p_FRcm, rotor.p_FRcm_F());
    put(MotionRow::v_WR, rotor.velocity_F(true));
    put(MotionRow::v_WRcm, rotor.velocity_F(false));
    to[MotionRow::rate * widest_lanes] = rotor.rate();
    put(MotionRow::R_FR, rotor.x_F());
    put(MotionRow::R_FR + 3, rotor.y_F());
    put(MotionRow::R_FR + 6, z_F);
    const std::size_t carrier = bodies.carrier(i + 1);
    if (carrier == 0) continue;  // the carrier turns as well
    k.rotors.set_matrix(MotionRow::R_FR_at_zero, i, k.R_FR(carrier - 1) * R_PC_at_zero_[i]);
  }
  const HingedCenter<double> center(bodies, frame);
  k.p_FCcm_F = vector(center.p_FCcm_F);
  k.v_WCcm_F = vector(center.v_WCcm_F);
}

GazeboStep::Multipliers HingedVehicle::multipliers(std::size_t hinge) const {
  const Spatial<double> load = bodies().load_of_hinge(hinge + 1);
  const BodyWork<double>& body = work_[hinge + 1];
  const Vec3<double>& f_W = load.linear;
  const Vector3d tau_W = vector(load.angular - laws::cross(body.p_OA_W, f_W));
  const Vector3d axis_W = vector(body.turn.direction.angular);
  const auto across_W = plane_space(axis_W);  // as in the step, whose end has turned the axis
  return {f_W.x,
          f_W.y,
          f_W.z,
          tau_W.dot(across_W[0]),
          tau_W.dot(across_W[1]),
          tau_W.dot(axis_W)};
}

bool HingedVehicle::is_high(std::size_t i, double reach, double time, double gravity_z) const {
  const double* const rows = &state_[i * BodyRow::count];
  const double lowest = rows[BodyRow::position + 2] - reach;
  const double rate_F = vector(bodies().state(0).vector(BodyRow::rate)).norm();
  const double fallen = std::min(0.0, gravity_z) * time * time / 2;
  // A shape moves with the body's centre of mass, and about that with the frame.
  const double sinks = rows[BodyRow::velocity + 2] - 3 * rate_F * reach;
  return lowest > 0 && lowest + fallen + time * sinks > 0;
}

}  // namespace quadcore
