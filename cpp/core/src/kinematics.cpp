#include "quadcore/kinematics.hpp"

#include "quadcore/elementary.hpp"

namespace quadcore {
namespace {

/// Rodrigues' formula: c 1 + (1 - c) a a^T + s [a x].
Matrix3d turn_about(const Vector3d& a, double angle) {
  const auto [s, c] = elementary::sincos(angle);
  const Vector3d b = (1 - c) * a;
  const double xy = b.x() * a.y(), xz = b.x() * a.z(), yz = b.y() * a.z();
  Matrix3d R;
  R << b.x() * a.x() + c, xy - s * a.z(), xz + s * a.y(),  //
      xy + s * a.z(), b.y() * a.y() + c, yz - s * a.x(),   //
      xz - s * a.y(), yz + s * a.x(), b.z() * a.z() + c;
  return R;
}

}  // namespace

const Matrix3d& Kinematics::R_FR(std::size_t i) const {
  Turn& turn = turns_[i];
  if (!turn.knows_R) {
    turn.R_FR = turn_about(rotors[i].axis_F, turn.angle) * turn.R_FR_at_zero;
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
    turn.angle = elementary::atan2(rotors[i].axis_F.dot(twice_sine), R.trace() - 1);
    turn.knows_angle = true;
  }
  return turn.angle;
}

}  // namespace quadcore
