#include "quadcore/drawing.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

namespace quadcore {

InertiaBox inertia_box(const Inertial& inertial) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> principal(inertial.inertia_in_link_axes());
  const Vector3d moments = principal.eigenvalues();
  Matrix3d axes = principal.eigenvectors();
  if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
  const Vector3d squares =
      6 / inertial.mass * (Vector3d::Constant(moments.sum()) - 2 * moments).cwiseMax(0);
  return {inertial.pose.xyz, Quaterniond(axes), squares.cwiseSqrt()};
}

double drawn_disc_radius(const Model& model) {
  const std::vector<Eigen::Isometry3d> poses = link_poses(model);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < poses.size(); ++i) {
    for (std::size_t j = 1; j < i; ++j) {
      const double apart = (poses[i].translation() - poses[j].translation()).norm();
      if (apart > 1e-3) nearest = std::min(nearest, apart);  // coaxial rotors share a position
    }
  }
  return nearest < std::numeric_limits<double>::infinity() ? 0.4 * nearest : 0.1;
}

}  // namespace quadcore
