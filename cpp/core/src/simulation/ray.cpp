#include "quadcore/ray.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadcore {
namespace {

/// Part of a line that is inside a convex set, by the distance from the line's origin.
struct Interval {
  double begin = -INFINITY, end = INFINITY;

  void intersect(double from, double to) {
    begin = std::max(begin, from);
    end = std::min(end, to);
  }
  void clear() { intersect(INFINITY, -INFINITY); }
  /// Return the first end in front of the origin; infinite if both lie behind it.
  double first() const {
    if (begin > end || end < 0) return INFINITY;
    return begin >= 0 ? begin : end;
  }
};

/// Keep what is between -half and half of one coordinate.
void cut_slab(Interval& inside, double from, double slope, double half) {
  if (slope == 0) {
    if (std::abs(from) > half) inside.clear();
    return;
  }
  const double one = (-half - from) / slope, other = (half - from) / slope;
  inside.intersect(std::min(one, other), std::max(one, other));
}

/// Keep what is within a radius of the origin of some coordinates.
template <class Coordinates>
void cut_ball(Interval& inside, const Coordinates& from, const Coordinates& slope, double radius) {
  const double a = slope.squaredNorm(), b = from.dot(slope);
  const double c = from.squaredNorm() - radius * radius;
  if (a == 0) {
    if (c > 0) inside.clear();
    return;
  }
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return inside.clear();
  const double root = std::sqrt(discriminant);
  inside.intersect((-b - root) / a, (-b + root) / a);
}

Interval inside_of_box(const Vector3d& from, const Vector3d& slope, const Vector3d& size) {
  Interval inside;
  for (int i = 0; i < 3; ++i) cut_slab(inside, from[i], slope[i], size[i] / 2);
  return inside;
}

/// Return the distance to a triangle (Moller, Trumbore, "Fast, Minimum Storage Ray/Triangle
/// Intersection", 1997).
double distance_to_triangle(const std::array<Vector3d, 3>& corners, const Vector3d& from,
                            const Vector3d& slope) {
  const Vector3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
  const Vector3d p = slope.cross(ac), arm = from - corners[0];
  const double determinant = ab.dot(p);
  if (determinant == 0) return INFINITY;
  const double u = arm.dot(p) / determinant;
  const Vector3d q = arm.cross(ab);
  const double v = slope.dot(q) / determinant;
  if (!(u >= 0 && v >= 0 && u + v <= 1)) return INFINITY;
  const double distance = ac.dot(q) / determinant;
  return distance >= 0 ? distance : INFINITY;
}

double distance_to_mesh(const Obstacle& obstacle, const Vector3d& from, const Vector3d& slope) {
  const Interval box = inside_of_box(from - obstacle.center, slope, obstacle.size);
  double nearest = INFINITY;
  if (box.first() == INFINITY) return nearest;
  for (const TriangleMesh::Triangle& triangle : obstacle.mesh->triangles) {
    nearest =
        std::min(nearest, distance_to_triangle(corners_of(*obstacle.mesh, triangle), from, slope));
  }
  return nearest;
}

/// A ray that leaves the plane on its upper side does not meet it.
double distance_to_plane(const Vector3d& normal, double height, const Ray& ray) {
  const double gap = height - normal.dot(ray.origin_W), slope = normal.dot(ray.direction_W);
  if (slope == 0 || (gap == 0 && slope > 0)) return INFINITY;
  const double distance = gap / slope;
  return distance >= 0 ? distance : INFINITY;
}

}  // namespace

double distance_along(const Ray& ray, const Obstacle& obstacle) {
  const Vector3d& size = obstacle.size;
  if (obstacle.kind == ShapeKind::plane) {
    return distance_to_plane(size, obstacle.position_W.z(), ray);
  }
  const Quaterniond to_own = obstacle.orientation_W.conjugate();
  const Vector3d from = to_own * (ray.origin_W - obstacle.position_W);
  const Vector3d slope = to_own * ray.direction_W;
  if (obstacle.kind == ShapeKind::mesh) return distance_to_mesh(obstacle, from, slope);
  if (obstacle.kind == ShapeKind::box) return inside_of_box(from, slope, size).first();
  Interval inside;
  if (obstacle.kind == ShapeKind::sphere) {
    cut_ball(inside, from, slope, size.x());
  } else {
    cut_ball<Eigen::Vector2d>(inside, from.head<2>(), slope.head<2>(), size.x());
    cut_slab(inside, from.z(), slope.z(), size.y() / 2);
  }
  return inside.first();
}

double range_along(const Ray& ray, const World& world, double maximum) {
  double nearest = INFINITY;
  if (world.ground_plane) nearest = distance_to_plane(Vector3d::UnitZ(), 0, ray);
  for (const Obstacle& obstacle : world.obstacles) {
    if (obstacle.kind != ShapeKind::plane) {  // a ball around it is farther than the nearest
      const Vector3d arm_W = obstacle.position_W - ray.origin_W;
      const double radius = outer_radius(obstacle), along = arm_W.dot(ray.direction_W);
      if (along + radius < 0 || along - radius > std::min(nearest, maximum)) continue;
      if (arm_W.squaredNorm() - along * along > radius * radius) continue;
    }
    nearest = std::min(nearest, distance_along(ray, obstacle));
  }
  return nearest <= maximum ? nearest : INFINITY;
}

}  // namespace quadcore
