#include "eigen_engine.hpp"

#include <algorithm>
#include <cmath>

#include "lowest_point.hpp"
#include "quadcore/error.hpp"

namespace quadcore {
namespace {

/// What only an engine of separate bodies can feel.
void refuse_tags(const Model& model) {
  const auto refuse = [](const std::string& where, const std::string& what) {
    throw InputError(where + ": " + what +
                     ", which the engine eigen does not model; remove it, or use the engine ode or "
                     "gazebo11");
  };
  for (const Link& link : model.links) {
    if (!link.tags.gravity) refuse(link.tags.where, "link '" + link.name + "' has no gravity");
    if (link.tags.damping_factor > 0) {
      refuse(link.tags.where, "link '" + link.name + "' has a <dampingFactor>");
    }
  }
  for (const Joint& joint : model.joints) {
    if (joint.friction > 0) refuse(joint.where, "joint '" + joint.name + "' has friction");
  }
}

}  // namespace

EigenEngine::EigenEngine(const Model& model, const World& world)
    : model_(model),
      body_(model),
      rotor_count_(static_cast<Eigen::Index>(model.joints.size())),
      gravity_W_(world.gravity_W),
      wind_W_(world.wind_W),
      windy_(!world.wind_W.isZero(0)),
      ground_(world.ground_plane),
      state_(VectorXd::Zero(kJoints + 2 * rotor_count_)),
      stage_(state_),
      rate_(state_),
      sum_(state_),
      kinematics_(model.joints.size()),
      loads_(model.joints.size()) {
  refuse_tags(model_);
  if (ground_) check_collisions(model_);
  kinematics_.p_FCcm_F = body_.p_FCcm_F;
  for (std::size_t i = 0; i < body_.rotors.size(); ++i) {
    kinematics_.rotors[i].axis_F = body_.rotors[i].axis_F;
    kinematics_.rotors[i].p_FRcm_F = body_.rotors[i].p_FRcm_F;
    kinematics_.set_R_FR_at_zero(i, body_.rotors[i].R_FR);
  }
  state_[kOrientation + 3] = 1;
  look(state_);
}

void EigenEngine::step(double dt, const ForceField& forces) {
  // Classical Runge-Kutta; kinematics_ shows state_ at the start, as the last step left it.
  differentiate(state_, forces);
  sum_ = rate_;
  stage(dt / 2, 2, forces);
  stage(dt / 2, 2, forces);
  stage(dt, 1, forces);
  for (Eigen::Index i = 0; i < state_.size(); ++i) state_[i] += dt / 6 * sum_[i];
  state_.segment<4>(kOrientation).normalize();
  for (Eigen::Index i = joint_angles(); i < state_.size(); ++i) {
    if (std::abs(state_[i]) > M_PI) state_[i] = std::remainder(state_[i], 2 * M_PI);
  }
  look(state_);
  if (ground_) refuse_ground();
}

void EigenEngine::stage(double reach, double weight, const ForceField& forces) {
  for (Eigen::Index i = 0; i < state_.size(); ++i) stage_[i] = state_[i] + reach * rate_[i];
  look(stage_);
  differentiate(stage_, forces);
  for (Eigen::Index i = 0; i < state_.size(); ++i) sum_[i] += weight * rate_[i];
}

void EigenEngine::look(const VectorXd& state) {
  Kinematics& k = kinematics_;
  // Between the stages the quaternion is off unit length, by less than the method's own error.
  k.q_WF.coeffs() = state.segment<4>(kOrientation);
  const Matrix3d R_WF = k.q_WF.toRotationMatrix();
  const Vector3d w_WF_F = state.segment<3>(kRate);
  const Vector3d v_WCcm_F = R_WF.transpose() * state.segment<3>(kVelocity);
  const Vector3d v_WF_F = v_WCcm_F - w_WF_F.cross(body_.p_FCcm_F);
  k.R_WF = R_WF;
  k.w_WF_F = w_WF_F;
  k.v_WCcm_F = v_WCcm_F;
  k.v_WF_F = v_WF_F;
  k.p_WF = state.segment<3>(kPosition) - R_WF * body_.p_FCcm_F;
  if (windy_) k.v_WA_F = R_WF.transpose() * wind_W_;
  const double* rates = state.data() + joint_rates();
  const double* angles = state.data() + joint_angles();
  for (std::size_t i = 0; i < body_.rotors.size(); ++i) {
    const Gyrostat::Rotor& rotor = body_.rotors[i];
    RotorKinematics& motion = k.rotors[i];
    const Vector3d v_WRcm_F = v_WF_F + w_WF_F.cross(rotor.p_FRcm_F);
    motion.v_WRcm_F = v_WRcm_F;
    motion.v_WR_F = rotor.centered ? v_WRcm_F : v_WF_F + w_WF_F.cross(rotor.p_FR_F);
    motion.rate = rates[i];
    k.set_angle(i, angles[i]);
  }
}

void EigenEngine::differentiate(const VectorXd& state, const ForceField& forces) {
  const Kinematics& k = kinematics_;
  loads_.clear();
  forces.evaluate(k, loads_);

  const Vector3d w = k.w_WF_F;
  Vector3d f_F = loads_.frame().force_F;
  Vector3d tau_F = loads_.frame().torque_F;  // about F's origin
  Vector3d h_F = body_.I_Ccm_F * w;          // angular momentum about C
  double* joint_rate = rate_.data() + joint_rates();
  double* joint_angle = rate_.data() + joint_angles();
  std::size_t i = 0;
  for (const Gyrostat::Rotor& rotor : body_.rotors) {
    const Vector3d f_R_F = loads_.rotor_force_F(i);
    const double rate = k.rotors[i].rate;
    const double joint_torque = loads_.joint_torque(i) - rotor.damping * rate;
    f_F += f_R_F;
    tau_F += rotor.p_FRcm_F.cross(f_R_F) - joint_torque * rotor.axis_F;
    h_F += rate * rotor.moment_axis_F;
    joint_rate[i] = joint_torque * rotor.inverse_moment;
    joint_angle[i] = rate;
    ++i;
  }
  tau_F -= body_.p_FCcm_F.cross(f_F) + w.cross(h_F);  // now about C
  // Every load is in the sum tau_F.
  if (!std::isfinite(tau_F.sum()) && !loads_.all_finite()) forces.refuse(k, loads_);
  const Vector3d angular_F = body_.inverse_reduced_I_F * tau_F;
  const Vector3d linear_W = k.R_WF * f_F * body_.inverse_mass + gravity_W_;
  for (const Gyrostat::Rotor& rotor : body_.rotors) *joint_rate++ -= rotor.axis_F.dot(angular_F);

  const double* v = state.data() + kVelocity;
  const double* q = state.data() + kOrientation;
  double* rate = rate_.data();
  std::copy_n(v, 3, rate + kPosition);
  rate[kOrientation + 0] = 0.5 * (q[3] * w.x() + q[1] * w.z() - q[2] * w.y());
  rate[kOrientation + 1] = 0.5 * (q[3] * w.y() + q[2] * w.x() - q[0] * w.z());
  rate[kOrientation + 2] = 0.5 * (q[3] * w.z() + q[0] * w.y() - q[1] * w.x());
  rate[kOrientation + 3] = -0.5 * (q[0] * w.x() + q[1] * w.y() + q[2] * w.z());
  std::copy_n(linear_W.data(), 3, rate + kVelocity);
  std::copy_n(angular_F.data(), 3, rate + kRate);
}

void EigenEngine::refuse_ground() const {
  if (lowest_point(model_, kinematics_) > 0) return;
  throw Error(
      "the vehicle touches the ground, for which the engine eigen has no contact; use the "
      "engine ode or gazebo11");
}

void EigenEngine::get_state(VehicleState& state) const {
  state.position = kinematics_.p_WF;
  state.orientation = kinematics_.q_WF;
  state.linear_velocity = kinematics_.R_WF * kinematics_.v_WF_F;
  state.angular_velocity = kinematics_.w_WF_F;
  state.rotor_velocity = state_.segment(joint_rates(), rotor_count_);
  state.rotor_angle = state_.segment(joint_angles(), rotor_count_);
}

void EigenEngine::set_state(const VehicleState& state) {
  const Quaterniond q = state.orientation.normalized();
  state_.segment<3>(kPosition) = state.position + q * body_.p_FCcm_F;
  state_.segment<4>(kOrientation) = q.coeffs();
  state_.segment<3>(kVelocity) =
      state.linear_velocity + q * state.angular_velocity.cross(body_.p_FCcm_F);
  state_.segment<3>(kRate) = state.angular_velocity;
  state_.segment(joint_rates(), rotor_count_) = state.rotor_velocity;
  state_.segment(joint_angles(), rotor_count_) =
      state.rotor_angle.unaryExpr([](double angle) { return std::remainder(angle, 2 * M_PI); });
  look(state_);
}

std::string EigenEngine::method() const {
  return "classical Runge-Kutta of fourth order on the reduced equations of motion";
}

std::vector<double> EigenEngine::save() const {
  return {state_.data(), state_.data() + state_.size()};
}

void EigenEngine::restore(const std::vector<double>& saved) {
  if (saved.size() != static_cast<std::size_t>(state_.size())) {
    throw InputError("snapshot: was taken from another model or engine; restore one of its own");
  }
  std::copy(saved.begin(), saved.end(), state_.data());
  look(state_);
}

}  // namespace quadcore
