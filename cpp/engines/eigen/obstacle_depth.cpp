#include "obstacle_depth.hpp"

#include <cmath>

namespace quadcore {
namespace {

Vector3d unit_or_z(const Vector3d& v) {
  const double length = v.norm();
  return length > 0 ? (v / length).eval() : Vector3d::UnitZ();
}

/// Return the depth in a shape that is bounded by several faces.
/// \param beyond   coordinates of the point beyond each face, negative inside
/// \param outward  columns: outward normals of the faces in the shape's axes
template <int n>
ObstacleDepth find_depth_by_faces(const Eigen::Matrix<double, n, 1>& beyond,
                                  const Eigen::Matrix<double, 3, n>& outward, double radius) {
  int nearest = 0;
  const double furthest = beyond.maxCoeff(&nearest);
  if (furthest <= 0) return {radius - furthest, outward.col(nearest)};
  const Eigen::Matrix<double, n, 1> outside = beyond.cwiseMax(0);
  const double distance = outside.norm();
  return {radius - distance, outward * outside / distance};
}

}  // namespace

ObstacleDepth find_depth(const Obstacle& obstacle, const Vector3d& p_W, double radius) {
  const Vector3d& size = obstacle.size;
  if (obstacle.kind == ShapeKind::plane) {
    return {radius - distance_to(obstacle, p_W), size.normalized()};
  }
  const Matrix3d R_WO = obstacle.orientation_W.toRotationMatrix();
  const Vector3d p = R_WO.transpose() * (p_W - obstacle.position_W);
  if (obstacle.kind == ShapeKind::sphere) {
    return {radius + size.x() - p.norm(), R_WO * unit_or_z(p)};
  }
  ObstacleDepth found = {0, Vector3d::UnitZ()};
  if (obstacle.kind == ShapeKind::box) {
    Matrix3d outward = Matrix3d::Identity();
    for (int i = 0; i < 3; ++i) outward(i, i) = p[i] < 0 ? -1 : 1;
    found = find_depth_by_faces<3>(p.cwiseAbs() - size / 2, outward, radius);
  } else {
    const double around = p.head<2>().norm();
    Eigen::Matrix<double, 3, 2> outward = Eigen::Matrix<double, 3, 2>::Zero();
    outward.block<2, 1>(0, 0) =
        around > 0 ? (p.head<2>() / around).eval() : Eigen::Vector2d::UnitX();
    outward(2, 1) = p.z() < 0 ? -1 : 1;
    found = find_depth_by_faces<2>({around - size.x(), std::abs(p.z()) - size.y() / 2}, outward,
                                   radius);
  }
  found.normal_W = R_WO * found.normal_W;
  return found;
}

}  // namespace quadcore
