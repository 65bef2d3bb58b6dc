#include "quadcore/kinematics.hpp"

#include <cmath>

namespace quadcore {

const Matrix3d& Kinematics::R_FR(std::size_t i) const {
  Turn& turn = turns_[i];
  if (!turn.knows_R) {
    turn.R_FR = Eigen::AngleAxisd(turn.angle, rotors[i].axis_F) * turn.R_FR_at_zero;
    turn.knows_R = true;
  }
  return turn.R_FR;
}

double Kinematics::angle(std::size_t i) const {
  Turn& turn = turns_[i];
  if (!turn.knows_angle) {
    // The turn about the axis: its skew part is sin(angle) [axis x], its trace 1 + 2 cos(angle).
    const Matrix3d R = turn.R_FR * turn.R_FR_at_zero.transpose();
    const Vector3d twice_sine(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
    turn.angle = std::atan2(rotors[i].axis_F.dot(twice_sine), R.trace() - 1);
    turn.knows_angle = true;
  }
  return turn.angle;
}

}  // namespace quadcore
