#include "eigen_engine.hpp"

#include <algorithm>
#include <cmath>

#include "lowest_point.hpp"
#include "quadcore/error.hpp"

namespace quadcore {

EigenEngine::EigenEngine(const Model& model, const World& world)
    : model_(model),
      body_(model),
      rotor_count_(static_cast<Eigen::Index>(model.joints.size())),
      gravity_W_(world.gravity_W),
      wind_W_(world.wind_W),
      ground_(world.ground_plane),
      state_(VectorXd::Zero(kJoints + 2 * rotor_count_)),
      stage_(state_),
      rate_(state_),
      sum_(state_),
      kinematics_(model.joints.size()),
      loads_(model.joints.size()) {
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
  differentiate(state_, forces, rate_);
  sum_ = state_ + dt / 6 * rate_;
  for (const auto& [reach, weight] : {std::pair{dt / 2, dt / 3}, {dt / 2, dt / 3}, {dt, dt / 6}}) {
    stage_ = state_ + reach * rate_;
    look(stage_);
    differentiate(stage_, forces, rate_);
    sum_ += weight * rate_;
  }
  state_ = sum_;
  state_.segment<4>(kOrientation).normalize();
  for (Eigen::Index i = joint_angles(); i < state_.size(); ++i) {
    if (std::abs(state_[i]) > M_PI) state_[i] = std::remainder(state_[i], 2 * M_PI);
  }
  look(state_);
  if (ground_) refuse_ground();
}

void EigenEngine::look(const VectorXd& state) {
  Kinematics& k = kinematics_;
  // Between the stages the quaternion is off unit length by the order of the method.
  const Quaterniond q(state.segment<4>(kOrientation).normalized());
  k.R_WF = q.toRotationMatrix();
  k.w_WF_F = state.segment<3>(kRate);
  k.v_WCcm_F = k.R_WF.transpose() * state.segment<3>(kVelocity);
  k.v_WF_F = k.v_WCcm_F - k.w_WF_F.cross(body_.p_FCcm_F);
  k.p_WF = state.segment<3>(kPosition) - k.R_WF * body_.p_FCcm_F;
  k.v_WA_F = k.R_WF.transpose() * wind_W_;
  for (std::size_t i = 0; i < body_.rotors.size(); ++i) {
    RotorKinematics& rotor = k.rotors[i];
    const auto row = static_cast<Eigen::Index>(i);
    rotor.v_WR_F = k.v_WF_F + k.w_WF_F.cross(body_.rotors[i].p_FR_F);
    rotor.v_WRcm_F = k.v_WF_F + k.w_WF_F.cross(body_.rotors[i].p_FRcm_F);
    rotor.rate = state[joint_rates() + row];
    rotor.angle = state[joint_angles() + row];
  }
  k.forget_R_FR();
}

void EigenEngine::differentiate(const VectorXd& state, const ForceField& forces, VectorXd& rate) {
  const Kinematics& k = kinematics_;
  loads_.clear();
  forces.evaluate(k, loads_);

  Vector3d f_F = loads_.frame().force_F;
  Vector3d tau_F = loads_.frame().torque_F;  // about F's origin
  Vector3d h_F = body_.I_Ccm_F * k.w_WF_F;   // angular momentum about C
  for (std::size_t i = 0; i < body_.rotors.size(); ++i) {
    const Gyrostat::Rotor& rotor = body_.rotors[i];
    const Vector3d& f_R_F = loads_.rotor_force_F(i);
    const double joint_torque = loads_.joint_torque(i) - rotor.damping * k.rotors[i].rate;
    f_F += f_R_F;
    tau_F += rotor.p_FRcm_F.cross(f_R_F) - joint_torque * rotor.axis_F;
    h_F += rotor.moment * k.rotors[i].rate * rotor.axis_F;
  }
  tau_F -= body_.p_FCcm_F.cross(f_F);  // now about C
  const Vector3d acceleration_F = body_.inverse_reduced_I_F * (tau_F - k.w_WF_F.cross(h_F));

  const auto q = state.segment<4>(kOrientation);
  const Vector3d& w = k.w_WF_F;
  rate.segment<3>(kPosition) = state.segment<3>(kVelocity);
  rate.segment<4>(kOrientation) << 0.5 * (q[3] * w + q.head<3>().cross(w)),
      -0.5 * q.head<3>().dot(w);
  rate.segment<3>(kVelocity) = k.R_WF * f_F / body_.mass + gravity_W_;
  rate.segment<3>(kRate) = acceleration_F;
  for (std::size_t i = 0; i < body_.rotors.size(); ++i) {
    const Gyrostat::Rotor& rotor = body_.rotors[i];
    const auto row = static_cast<Eigen::Index>(i);
    const double joint_torque = loads_.joint_torque(i) - rotor.damping * k.rotors[i].rate;
    rate[joint_rates() + row] = joint_torque / rotor.moment - rotor.axis_F.dot(acceleration_F);
    rate[joint_angles() + row] = k.rotors[i].rate;
  }
}

void EigenEngine::refuse_ground() const {
  if (lowest_point(model_, kinematics_) > 0) return;
  throw Error("the vehicle touches the ground, for which the engine eigen has no contact; use the "
              "engine ode or gazebo11");
}

void EigenEngine::get_state(VehicleState& state) const {
  state.position = kinematics_.p_WF;
  state.orientation.coeffs() = state_.segment<4>(kOrientation);
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
