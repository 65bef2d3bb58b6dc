#include "quadcore/control/attitude_loop.hpp"

#include "numbers.hpp"

namespace quadcore::control {

AttitudeLoop::AttitudeLoop(const ModelledVehicle& model, const AttitudeGains& gains)
    : model_(model), gains_(gains) {}

Vector3d AttitudeLoop::angular_acceleration(const Quaterniond& q_FD,
                                            const Vector3d& w_error_F) const {
  return vector_of(
      control::angular_acceleration(numbers_of(gains_), numbers_of(q_FD), numbers_of(w_error_F)));
}

Vector3d AttitudeLoop::angular_acceleration(const Vector3d& w_error_F) const {
  return vector_of(by_components(numbers_of(gains_).d, numbers_of(w_error_F)));
}

Vector3d AttitudeLoop::torque(const Odometry& now, const Vector3d& h_F,
                              const Vector3d& dw_WF_F) const {
  const MeasuredNumbers<double> motion = numbers_of(now);
  return vector_of(attitude_torque(numbers_of(model_), gains_.drag, gains_.gyroscopic,
                                   laws::rotation(motion.q_WF), motion.v_WF_W, motion.w_WF_F,
                                   numbers_of(h_F), numbers_of(dw_WF_F)));
}

}  // namespace quadcore::control
