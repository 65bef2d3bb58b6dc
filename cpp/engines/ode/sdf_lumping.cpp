#include "sdf_lumping.hpp"

#include "quadcore/plugin/elementary.hpp"

namespace quadcore {
namespace {

/// Return the axes of a frame rotated by roll, pitch, yaw as the rows of a matrix: R_FL.
Matrix3d rows_of_axes(const Vector3d& rpy) {
  const double sr = elementary::sin(rpy.x()), cr = elementary::cos(rpy.x());
  const double sp = elementary::sin(rpy.y()), cp = elementary::cos(rpy.y());
  const double sy = elementary::sin(rpy.z()), cy = elementary::cos(rpy.z());
  Matrix3d R;
  R << cy * cp, sy * cp, -sp,                                   //
      cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr,  //
      cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr;
  return R;
}

/// Mass, centre of mass and inertia about the origin, along common axes (ODE's dMass).
struct PointInertia {
  double mass;
  Vector3d center;
  Matrix3d inertia;

  void make_symmetric() {
    inertia(1, 0) = inertia(0, 1);
    inertia(2, 0) = inertia(0, 2);
    inertia(2, 1) = inertia(1, 2);
  }

  void rotate(const Matrix3d& R) {
    const Matrix3d half = inertia * R.transpose();
    inertia = (R * half).eval();
    make_symmetric();
    center = (R * center).eval();
  }

  /// Transform from axes rotated by roll, pitch, yaw to the reference axes, one angle at a time.
  void rotate_back(const Vector3d& rpy) {
    for (int i = 0; i < 3; ++i) rotate(rows_of_axes(-rpy[i] * Vector3d::Unit(i)));
  }

  void translate(const Vector3d& shift) {
    const Matrix3d before = skew(center), after = skew(shift + center);
    const Matrix3d was = before * before, is = after * after;
    inertia += mass * (was - is);
    make_symmetric();
    center += shift;
  }

  void add(const PointInertia& other) {
    const double per_mass = 1 / (mass + other.mass);
    center = (center * mass + other.center * other.mass) * per_mass;
    mass += other.mass;
    inertia += other.inertia;
  }
};

PointInertia about_link_origin(const SdfInertial& inertial) {
  PointInertia sum{inertial.mass, Vector3d::Zero(), inertial.inertia};
  sum.rotate_back(urdf_rpy(inertial.pose.q));
  sum.translate(inertial.pose.xyz);
  return sum;
}

}  // namespace

void SdfInertial::add(const SdfInertial& link, const SdfPose& joint) {
  PointInertia sum = about_link_origin(*this), added = about_link_origin(link);
  added.rotate_back(urdf_rpy(joint.q));
  added.translate(joint.xyz);
  sum.add(added);
  mass = sum.mass;
  pose.xyz = sum.center;
  sum.translate(-pose.xyz);
  sum.rotate(rows_of_axes(urdf_rpy(pose.q)));
  inertia = sum.inertia;
}

}  // namespace quadcore
