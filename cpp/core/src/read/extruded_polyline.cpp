#include "extruded_polyline.hpp"

#include <algorithm>
#include <numeric>

namespace quadcore {
namespace {

using Point = Eigen::Vector2d;
using Index = std::uint32_t;

/// Return twice the area of a triangle, positive if it turns counterclockwise.
double turn(const Point& a, const Point& b, const Point& c) {
  const Point ab = b - a, ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x();
}

bool is_inside(const Point& p, const Point& a, const Point& b, const Point& c) {
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

/// Return whether two sides of a polygon cross each other.
bool crosses_itself(const std::vector<Point>& points) {
  const std::size_t n = points.size();
  const auto is_same_side = [](double one, double other) { return (one > 0) == (other > 0); };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = i + 2; k < n; ++k) {
      if (i == 0 && k + 1 == n) continue;  // neighbours
      const Point &a = points[i], &b = points[i + 1], &c = points[k], &d = points[(k + 1) % n];
      if (!is_same_side(turn(a, b, c), turn(a, b, d)) &&
          !is_same_side(turn(c, d, a), turn(c, d, b))) {
        return true;
      }
    }
  }
  return false;
}

/// Divide a counterclockwise polygon into triangles by cutting off ears (G. Meisters, "Polygons
/// have ears", 1975). Empty if there is none to cut off.
std::vector<TriangleMesh::Triangle> cut_ears(const std::vector<Point>& points) {
  std::vector<TriangleMesh::Triangle> triangles;
  std::vector<Index> left(points.size());
  std::iota(left.begin(), left.end(), Index{0});
  while (left.size() >= 3) {
    const std::size_t n = left.size();
    std::size_t ear = 0;
    for (; ear < n; ++ear) {
      const Index a = left[(ear + n - 1) % n], b = left[ear], c = left[(ear + 1) % n];
      if (!(turn(points[a], points[b], points[c]) > 0)) continue;
      const bool is_empty = std::none_of(left.begin(), left.end(), [&](Index i) {
        return i != a && i != b && i != c && is_inside(points[i], points[a], points[b], points[c]);
      });
      if (is_empty) break;
    }
    if (ear == n) return {};
    triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

}  // namespace

std::optional<TriangleMesh> extrude_polyline(std::vector<Point> points, double height) {
  if (points.size() > 1 && points.front() == points.back()) points.pop_back();
  double area = 0;
  for (std::size_t i = 2; i < points.size(); ++i) area += turn(points[0], points[i - 1], points[i]);
  if (area < 0) std::reverse(points.begin(), points.end());
  if (crosses_itself(points)) return {};
  const std::vector<TriangleMesh::Triangle> caps = cut_ears(points);
  if (caps.empty()) return {};
  TriangleMesh mesh;
  for (const double z : {0.0, height}) {
    for (const Point& p : points) mesh.vertices.push_back(Vector3d(p.x(), p.y(), z).cast<float>());
  }
  const auto n = static_cast<Index>(points.size());
  for (const auto& [a, b, c] : caps) {
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({n + a, n + b, n + c});
  }
  for (Index i = 0; i < n; ++i) {
    const Index next = (i + 1) % n;
    mesh.triangles.push_back({i, next, n + next});
    mesh.triangles.push_back({i, n + next, n + i});
  }
  return mesh;
}

}  // namespace quadcore
