#include "quadcore/plugin/obstacle.hpp"

#include <algorithm>
#include <cmath>

namespace quadcore {
namespace {

/// Return the signed distance of a point from a box [m].
/// \param outside  coordinates of the point beyond the box's faces, negative inside
template <class Coordinates>
double distance_to_corner(const Coordinates& outside) {
  return outside.cwiseMax(0).norm() + std::min(0.0, outside.maxCoeff());
}

}  // namespace

std::array<Vector3d, 3> corners_of(const TriangleMesh& mesh,
                                   const TriangleMesh::Triangle& triangle) {
  std::array<Vector3d, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) corners[i] = mesh.vertices[triangle[i]].cast<double>();
  return corners;
}

Vector3d project_onto_triangle(const std::array<Vector3d, 3>& corners, const Vector3d& p) {
  // C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.5: the region of the triangle's
  // plane in which the point's projection lies.
  const Vector3d &a = corners[0], &b = corners[1], &c = corners[2];
  const Vector3d ab = b - a, ac = c - a;
  const double d1 = ab.dot(p - a), d2 = ac.dot(p - a);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = ab.dot(p - b), d4 = ac.dot(p - b);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const double d5 = ab.dot(p - c), d6 = ac.dot(p - c);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  const double area = va + vb + vc;
  return area > 0 ? (a + vb / area * ab + vc / area * ac).eval() : a;
}

double distance_to(const Obstacle& obstacle, const Vector3d& p_W) {
  if (obstacle.kind != ShapeKind::mesh) return least_distance_to(obstacle, p_W);
  const Vector3d p = obstacle.orientation_W.conjugate() * (p_W - obstacle.position_W);
  double nearest = INFINITY;
  for (const TriangleMesh::Triangle& triangle : obstacle.mesh->triangles) {
    const Vector3d q = project_onto_triangle(corners_of(*obstacle.mesh, triangle), p);
    nearest = std::min(nearest, (p - q).norm());
  }
  return nearest;
}

double least_distance_to(const Obstacle& obstacle, const Vector3d& p_W) {
  const Vector3d& size = obstacle.size;
  if (obstacle.kind == ShapeKind::plane) {
    return (size.dot(p_W) - obstacle.position_W.z()) / size.norm();
  }
  const Vector3d arm_W = p_W - obstacle.position_W;
  if (obstacle.kind == ShapeKind::sphere) return arm_W.norm() - size.x();
  const Vector3d p = obstacle.orientation_W.conjugate() * arm_W;
  if (obstacle.kind == ShapeKind::box || obstacle.kind == ShapeKind::mesh) {
    return distance_to_corner(((p - obstacle.center).cwiseAbs() - size / 2).eval());
  }
  const Eigen::Vector2d beyond(p.head<2>().norm() - size.x(), std::abs(p.z()) - size.y() / 2);
  return distance_to_corner(beyond);
}

double outer_radius(ShapeKind kind, const Vector3d& size) {
  switch (kind) {
    case ShapeKind::box:
      return size.norm() / 2;
    case ShapeKind::cylinder:
      return Eigen::Vector2d(size.x(), size.y() / 2).norm();
    case ShapeKind::sphere:
      return size.x();
    default:
      return 0;
  }
}

double outer_radius(const Obstacle& obstacle) {
  switch (obstacle.kind) {
    case ShapeKind::plane:
      return INFINITY;
    case ShapeKind::mesh:
      return obstacle.center.norm() + obstacle.size.norm() / 2;
    default:
      return outer_radius(obstacle.kind, obstacle.size);
  }
}

}  // namespace quadcore
