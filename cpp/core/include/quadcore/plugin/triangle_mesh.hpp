#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Triangles in the order of their file. Gazebo's collider has vertices of single precision.
struct TriangleMesh {
  /// Indices of three vertices.
  using Triangle = std::array<std::uint32_t, 3>;

  std::vector<Eigen::Vector3f> vertices;  ///< m
  std::vector<Triangle> triangles;        ///< the faces
};

/// Return the corners of a triangle.
std::array<Vector3d, 3> corners_of(const TriangleMesh& mesh,
                                   const TriangleMesh::Triangle& triangle);

/// Return the point of a triangle that is nearest to a point.
Vector3d project_onto_triangle(const std::array<Vector3d, 3>& corners, const Vector3d& p);

}  // namespace quadcore
