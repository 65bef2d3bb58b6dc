#include "firmware/motor_mix.hpp"

#include <algorithm>
#include <string>

#include "quadcore/plugin/error.hpp"

namespace quadcore::control {

MotorMix::MotorMix(const ModelledVehicle& model, double hover, double full, int exponent)
    : hover_(hover), full_(full), exponent_(exponent) {
  const Eigen::Index n = model.effectiveness.cols();
  share_ = model.mass * model.gravity / static_cast<double>(n);
  effect_.resize(4, n);
  weights_.resize(3, n);
  double arm = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double force = model.effectiveness(2, i);
    if (!(force > 0)) {
      throw InputError("rotor " + std::to_string(i + 1) +
                       " does not push along z of the frame, as a firmware's controller assumes. "
                       "Use another controller.");
    }
    effect_.col(i) = model.effectiveness.col(i).tail<4>() / force;
    weights_.col(i) << effect_(1, i), effect_(2, i), (effect_(3, i) < 0 ? -1 : 1);
    arm = std::max(arm, weights_.col(i).head<2>().norm());
  }
  weights_.topRows<2>() /= arm;
}

Demand MotorMix::demand(const MotorOutputs& outputs) const {
  const Vector3d turning(outputs.roll, outputs.pitch, outputs.yaw);
  VectorXd commands = weights_.transpose() * turning;
  commands.array() += outputs.thrust;
  commands.array() -= std::max(0.0, commands.maxCoeff() - full_);
  const VectorXd relative = commands.cwiseMax(0.0) / hover_;
  const VectorXd thrusts =
      share_ * (exponent_ == 2 ? VectorXd(relative.cwiseProduct(relative)) : relative);
  const Eigen::Vector4d sum = effect_ * thrusts;
  return {sum(0), sum.tail<3>()};
}

}  // namespace quadcore::control
