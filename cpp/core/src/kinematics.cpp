#include "quadcore/kinematics.hpp"

namespace quadcore {

const Matrix3d& Kinematics::R_FR(std::size_t i) const {
  if (!known_[i]) {
    const RotorKinematics& rotor = rotors[i];
    R_FR_[i] = Eigen::AngleAxisd(rotor.angle, rotor.axis_F).toRotationMatrix() * R_FR_at_zero_[i];
    known_[i] = 1;
  }
  return R_FR_[i];
}

}  // namespace quadcore
