#pragma once

#include <string>
#include <vector>

#include "quadcore/plugin/triangle_mesh.hpp"

namespace quadcore {

/// A part of a mesh file.
struct SubMesh {
  std::string name;
  std::vector<Vector3d> vertices;  ///< m
  std::vector<TriangleMesh::Triangle> triangles;
};

/// Read a mesh file (.stl, .obj or .dae) as Gazebo does: a .dae's unit counts, its up_axis does
/// not. Throws InputError naming the file and what is wrong.
std::vector<SubMesh> read_mesh_file(const std::string& path);

/// Read the text of each format.
/// \param path  for errors
SubMesh read_stl(const std::string& path, const std::string& content);
SubMesh read_obj(const std::string& path, const std::string& content);
std::vector<SubMesh> read_collada(const std::string& path, const std::string& content);

/// Throw InputError because a mesh file is broken.
[[noreturn]] void refuse_mesh(const std::string& path, const std::string& what);

}  // namespace quadcore
