#include "surface_points.hpp"

#include <algorithm>
#include <cmath>

#include "quadcore/plugin/elementary.hpp"

namespace quadcore {
namespace {

constexpr double spacing = 0.1;      // m
constexpr int most_per_side = 5;     // points
constexpr int around_cylinder = 12;  // points

/// Return places from one end of a length to the other.
std::vector<double> divide(double length) {
  const int count = std::clamp(static_cast<int>(std::ceil(length / spacing)) + 1, 2, most_per_side);
  std::vector<double> places;
  for (int i = 0; i < count; ++i) places.push_back(length * (i / (count - 1.0) - 0.5));
  return places;
}

}  // namespace

std::vector<Vector3d> spread_points(const Collision& shape) {
  if (shape.kind == ShapeKind::sphere) return {Vector3d::Zero()};
  std::vector<Vector3d> points;
  if (shape.kind == ShapeKind::box) {
    const Vector3d half = shape.size / 2;
    for (const double x : divide(shape.size.x())) {
      for (const double y : divide(shape.size.y())) {
        for (const double z : divide(shape.size.z())) {
          const Vector3d p(x, y, z);
          if ((half - p.cwiseAbs()).minCoeff() <= 0) points.push_back(p);
        }
      }
    }
    return points;
  }
  const double radius = shape.size.x(), length = shape.size.y();
  const std::vector<double> levels = divide(length);
  for (const double z : levels) {
    const bool is_end = z == levels.front() || z == levels.back();
    const bool has_inner = is_end && radius > spacing;
    for (int ring = has_inner ? 1 : 2; ring <= 2; ++ring) {
      for (int i = 0; i < around_cylinder; ++i) {
        const elementary::SineCosine turned = elementary::sincos(2 * M_PI * i / around_cylinder);
        points.emplace_back(radius * ring / 2 * turned.cos, radius * ring / 2 * turned.sin, z);
      }
    }
    if (is_end) points.emplace_back(0, 0, z);
  }
  return points;
}

}  // namespace quadcore
