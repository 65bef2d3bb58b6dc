#pragma once

#include <map>
#include <memory>
#include <string>

#include "quadcore/plugin/triangle_mesh.hpp"
#include "xml.hpp"

namespace quadcore {

/// Name of the element that contains the triangles of a `<mesh>` in a world that needs no other
/// file. The first `<mesh>` of a file and submesh has it, others share it.
constexpr const char* embedded_mesh = "embedded_mesh";

/// Return what identifies the triangles of a `<mesh>`: its URI and submesh.
std::string mesh_key(const Xml::Element& mesh);

/// Return the URI of a `<mesh>`, or "".
std::string mesh_uri(const Xml::Element& mesh);

/// Return the text between `<embedded_mesh>` and `</embedded_mesh>` for a mesh file: a line of
/// vertices, each once, and one of triangles, both as hexadecimal bits. Throws InputError if the
/// file is broken or lacks the submesh.
std::string embed_mesh(const std::string& path, const Xml::Element& mesh);

/// The triangles that a world contains, by mesh_key().
class EmbeddedMeshes {
 public:
  explicit EmbeddedMeshes(const Xml& xml);

  /// Return the triangles of a `<mesh>`, scaled in double precision as in Gazebo, or null.
  std::shared_ptr<const TriangleMesh> find(const Xml::Element& mesh, const Vector3d& scale);

 private:
  void collect(const Xml::Element& parent);

  const Xml& xml_;
  std::map<std::string, const Xml::Element*> elements_;
  std::map<std::string, std::shared_ptr<const TriangleMesh>> scaled_;  ///< by key and scale
};

}  // namespace quadcore
