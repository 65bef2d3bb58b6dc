#include "contact_points.hpp"

#include <algorithm>
#include <cmath>

#include "cylinder_pair.hpp"
#include "ode_math.hpp"

namespace quadcore {
namespace {

bool are_sphere_and_mesh(dGeomID one, dGeomID other) {
  const int first = dGeomGetClass(one), second = dGeomGetClass(other);
  return std::min(first, second) == dSphereClass && std::max(first, second) == dTriMeshClass;
}

/// Merge the points of a sphere and a mesh into one, as Gazebo's ODE does: their mean position, and
/// the sum s of their normals times their depths. The depth is |s| / sqrt(number of points).
int merge_of_sphere(std::vector<dContactGeom>& points, int found) {
  if (found < 2) return found;
  Vector3d p_W = Vector3d::Zero(), s_W = Vector3d::Zero();
  for (int i = 0; i < found; ++i) {
    const dContactGeom& point = points[static_cast<std::size_t>(i)];
    p_W += vec(point.pos);
    s_W += point.depth * vec(point.normal);
  }
  p_W /= found;
  points[0].depth = std::sqrt(s_W.squaredNorm() / found);
  s_W.normalize();
  std::copy_n(p_W.data(), 3, points[0].pos);
  std::copy_n(s_W.data(), 3, points[0].normal);
  return 1;
}

}  // namespace

int find_points(dGeomID one, dGeomID other, std::vector<dContactGeom>& points) {
  if (are_cylinders(one, other)) return collide_cylinders(one, other, points[0]);
  const int found = dCollide(one, other, most_points, points.data(), sizeof points[0]);
  return are_sphere_and_mesh(one, other) ? merge_of_sphere(points, found) : found;
}

int keep_points(std::vector<dContactGeom>& points, int found, int most) {
  if (found <= most) return found;
  if (most == 0) return 0;
  const auto last = points.begin() + most - 1;
  *last = *std::max_element(
      last, points.begin() + found,
      [](const dContactGeom& one, const dContactGeom& other) { return one.depth < other.depth; });
  return most;
}

}  // namespace quadcore
