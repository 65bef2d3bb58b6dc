#include "mesh_file.hpp"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

constexpr double largest_coordinate = 1e9;  // m

std::string read_content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  if (!file) refuse_mesh(path, "the file cannot be read");
  return content.str();
}

void check(const std::string& path, const SubMesh& part) {
  for (const Vector3d& v : part.vertices) {
    if (!(v.cwiseAbs().maxCoeff() <= largest_coordinate)) {
      refuse_mesh(path, "a coordinate is not finite or exceeds 1e9 m");
    }
  }
  for (const TriangleMesh::Triangle& triangle : part.triangles) {
    for (const std::uint32_t index : triangle) {
      if (index >= part.vertices.size()) refuse_mesh(path, "a triangle names a missing vertex");
    }
  }
}

/// Return a number that begins at a place in a text, and move the place behind it.
Vector3d read_three(const std::string& path, std::istringstream& line) {
  Vector3d v;
  for (int i = 0; i < 3; ++i) {
    std::string word;
    line >> word;
    const auto number = parse_number(word);
    if (!number) refuse_mesh(path, "'" + word + "' is no coordinate");
    // These formats have single precision in Gazebo.
    v[i] = static_cast<float>(*number);
  }
  return v;
}

SubMesh read_binary_stl(const std::string& path, const std::string& content) {
  constexpr std::size_t header = 80, per_triangle = 50, normal = 12;
  std::uint32_t count = 0;
  if (content.size() < header + sizeof count) refuse_mesh(path, "the file ends in its header");
  std::memcpy(&count, content.data() + header, sizeof count);
  const std::size_t begin = header + sizeof count;
  if ((content.size() - begin) / per_triangle < count) {
    refuse_mesh(path, "the file ends before its last triangle");
  }
  SubMesh mesh;
  for (std::uint32_t t = 0; t < count; ++t) {
    float corners[9];
    std::memcpy(corners, content.data() + begin + t * per_triangle + normal, sizeof corners);
    for (int i = 0; i < 3; ++i) {
      mesh.vertices.emplace_back(corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]);
    }
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

}  // namespace

void refuse_mesh(const std::string& path, const std::string& what) {
  throw InputError(path + ": " + what + ". Export the mesh again.");
}

SubMesh read_stl(const std::string& path, const std::string& content) {
  // Binary files may begin with "solid" too, but contain no "facet" near their beginning.
  const bool is_text =
      content.rfind("solid", 0) == 0 && content.substr(0, 1000).find("facet") != std::string::npos;
  if (!is_text) return read_binary_stl(path, content);
  SubMesh mesh;
  std::istringstream lines(content);
  for (std::string text; std::getline(lines, text);) {
    std::istringstream line(text);
    std::string word;
    line >> word;
    if (lower(word) == "vertex") mesh.vertices.push_back(read_three(path, line));
  }
  if (mesh.vertices.size() % 3 != 0) refuse_mesh(path, "the file ends within a triangle");
  for (std::uint32_t i = 0; i < mesh.vertices.size(); i += 3) {
    mesh.triangles.push_back({i, i + 1, i + 2});
  }
  return mesh;
}

SubMesh read_obj(const std::string& path, const std::string& content) {
  SubMesh mesh;
  std::istringstream lines(content);
  for (std::string text; std::getline(lines, text);) {
    std::istringstream line(text);
    std::string word;
    line >> word;
    if (word == "v") mesh.vertices.push_back(read_three(path, line));
    if (word != "f") continue;
    std::vector<std::uint32_t> face;
    for (std::string corner; line >> corner;) {
      const auto index = parse_number(corner.substr(0, corner.find('/')));
      if (!index || *index == 0 || std::abs(*index) > 4e9 || *index != std::floor(*index)) {
        refuse_mesh(path, "'" + corner + "' is no corner of a face");
      }
      // Negative indices count from the last vertex.
      const double from_start =
          *index < 0 ? static_cast<double>(mesh.vertices.size()) + *index : *index - 1;
      if (from_start < 0) refuse_mesh(path, "a triangle names a missing vertex");
      face.push_back(static_cast<std::uint32_t>(from_start));
    }
    for (std::size_t i = 2; i < face.size(); ++i) {
      mesh.triangles.push_back({face[0], face[i - 1], face[i]});
    }
  }
  return mesh;
}

std::vector<SubMesh> read_mesh_file(const std::string& path) {
  const std::string kind = lower(std::filesystem::path(path).extension().string());
  std::vector<SubMesh> parts;
  if (kind == ".stl") {
    parts = {read_stl(path, read_content(path))};
  } else if (kind == ".obj") {
    parts = {read_obj(path, read_content(path))};
  } else if (kind == ".dae") {
    parts = read_collada(path, read_content(path));
  } else {
    throw InputError(path + ": a mesh of this format is not supported. Use .stl, .dae or .obj.");
  }
  std::size_t triangles = 0;
  for (const SubMesh& part : parts) {
    check(path, part);
    triangles += part.triangles.size();
  }
  if (triangles == 0) refuse_mesh(path, "the file has no triangles");
  return parts;
}

}  // namespace quadcore
