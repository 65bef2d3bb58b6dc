#include "quadcore/plugin/kinematics.hpp"

#include "lanes/turn.hpp"
#include "quadcore/plugin/elementary.hpp"

namespace quadcore {
namespace {

laws::Vec3<double> lanes(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

Matrix3d Kinematics::R_FR(std::size_t i) const {
  if (has_rotations_) return rotors.matrix(MotionRow::R_FR, i);
  const auto [sin, cos] = elementary::sincos(rotors.number(MotionRow::angle, i));
  const laws::SineCosine<double> angle{sin, cos};
  const laws::Vec3<double> axis_F = lanes(rotors.vector(MotionRow::axis, i));
  Matrix3d R_FR;
  for (int column = 0; column < 3; ++column) {
    const auto row = MotionRow::R_FR_at_zero + 3 * static_cast<std::size_t>(column);
    const auto turned_F = laws::turned(axis_F, angle, lanes(rotors.vector(row, i)));
    R_FR.col(column) << turned_F.x, turned_F.y, turned_F.z;
  }
  return R_FR;
}

double Kinematics::angle(std::size_t i) const {
  if (!has_rotations_) return rotors.number(MotionRow::angle, i);
  // Rotation about the axis: its skew part is sin(angle) [axis x], its trace 1 + 2 cos(angle).
  const Matrix3d R = R_FR(i) * rotors.matrix(MotionRow::R_FR_at_zero, i).transpose();
  const Vector3d twice_sine(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  return elementary::atan2(rotors[i].axis_F.dot(twice_sine), R.trace() - 1);
}

}  // namespace quadcore
