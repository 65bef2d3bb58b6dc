#include "embedded_meshes.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "mesh_file.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"
#include "sdf_values.hpp"

namespace quadcore {
namespace {

using Element = Xml::Element;

std::string text_in(const Element* e) { return e && e->GetText() ? trimmed(e->GetText()) : ""; }

bool is_centered(const Element& mesh) {
  const std::string text = lower(text_in(descend(&mesh, {"submesh", "center"})));
  return text == "true" || text == "1";
}

/// Move the middle of a part's bounding box to the origin.
void center(SubMesh& part) {
  Vector3d least = Vector3d::Constant(std::numeric_limits<double>::max()), most = -least;
  for (const Vector3d& v : part.vertices) least = least.cwiseMin(v), most = most.cwiseMax(v);
  const Vector3d middle = least + (most - least) * 0.5;
  for (Vector3d& v : part.vertices) v -= middle;
}

/// Reads numbers from a text without copying it.
class NumberReader {
 public:
  NumberReader(const Xml& xml, const Element& e) : xml_(xml), e_(e) {
    at_ = e.GetText() ? e.GetText() : "";
  }
  template <class Number, class Parse>
  bool next(Number& number, const Parse& parse) {
    char* end = nullptr;
    number = parse(at_, &end);
    if (end == at_) return false;
    at_ = end;
    return true;
  }
  [[noreturn]] void fail() const { xml_.fail(e_, "the embedded mesh is damaged. Remove it."); }

 private:
  const Xml& xml_;
  const Element& e_;
  const char* at_;
};

TriangleMesh read_triangles(const Xml& xml, const Element& embedded) {
  TriangleMesh mesh;
  NumberReader vertices(xml, xml.required_child(embedded, "vertices"));
  const auto to_float = [](const char* text, char** end) { return std::strtof(text, end); };
  for (Eigen::Vector3f v; vertices.next(v.x(), to_float);) {
    if (!vertices.next(v.y(), to_float) || !vertices.next(v.z(), to_float)) vertices.fail();
    mesh.vertices.push_back(v);
  }
  NumberReader indices(xml, xml.required_child(embedded, "triangles"));
  const auto to_index = [](const char* text, char** end) {
    return static_cast<std::uint32_t>(std::strtoul(text, end, 10));
  };
  for (TriangleMesh::Triangle t; indices.next(t[0], to_index);) {
    if (!indices.next(t[1], to_index) || !indices.next(t[2], to_index)) indices.fail();
    for (const std::uint32_t index : t) {
      if (index >= mesh.vertices.size()) indices.fail();
    }
    mesh.triangles.push_back(t);
  }
  if (mesh.triangles.empty()) indices.fail();
  return mesh;
}

}  // namespace

std::string mesh_uri(const Element& mesh) {
  const Element* uri = mesh.FirstChildElement("uri");
  return text_in(uri ? uri : mesh.FirstChildElement("filename"));
}

std::string mesh_key(const Element& mesh) {
  const std::string part = text_in(descend(&mesh, {"submesh", "name"}));
  return mesh_uri(mesh) + (part.empty() ? "" : " " + part) + (is_centered(mesh) ? " center" : "");
}

std::string embed_mesh(const std::string& path, const Element& mesh) {
  std::vector<SubMesh> parts = read_mesh_file(path);
  const std::string wanted = text_in(descend(&mesh, {"submesh", "name"}));
  std::string vertices, triangles;
  std::size_t first = 0;
  for (SubMesh& part : parts) {
    if (!wanted.empty() && part.name != wanted) continue;
    if (!wanted.empty() && is_centered(mesh)) center(part);
    for (const Vector3d& v : part.vertices) {
      std::array<char, 64> text;
      const Eigen::Vector3f f = v.cast<float>();
      std::snprintf(text.data(), text.size(), "%.9g %.9g %.9g ", static_cast<double>(f.x()),
                    static_cast<double>(f.y()), static_cast<double>(f.z()));
      vertices += text.data();
    }
    for (const TriangleMesh::Triangle& t : part.triangles) {
      for (const std::uint32_t index : t) triangles += std::to_string(first + index) + " ";
    }
    first += part.vertices.size();
    if (!wanted.empty()) break;
  }
  if (triangles.empty()) {
    throw InputError(path + ": the submesh '" + wanted + "' does not exist. Correct its name.");
  }
  return "<vertices>" + vertices + "</vertices>\n<triangles>" + triangles + "</triangles>";
}

EmbeddedMeshes::EmbeddedMeshes(const Xml& xml) : xml_(xml) { collect(xml.root()); }

void EmbeddedMeshes::collect(const Element& parent) {
  for (const Element* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
    if (e->Name() == std::string("mesh") && e->FirstChildElement(embedded_mesh)) {
      elements_.emplace(mesh_key(*e), e->FirstChildElement(embedded_mesh));
    } else {
      collect(*e);
    }
  }
}

std::shared_ptr<const TriangleMesh> EmbeddedMeshes::find(const Element& mesh,
                                                         const Vector3d& scale) {
  const std::string key = mesh_key(mesh);
  const auto element = elements_.find(key);
  if (element == elements_.end()) return nullptr;
  std::string name = key;
  for (int i = 0; i < 3; ++i) append_shortest(scale[i], name += ' ');
  std::shared_ptr<const TriangleMesh>& found = scaled_[name];
  if (!found) {
    TriangleMesh read = read_triangles(xml_, *element->second);
    for (Eigen::Vector3f& v : read.vertices) {
      v = v.cast<double>().cwiseProduct(scale).cast<float>();
    }
    found = std::make_shared<const TriangleMesh>(std::move(read));
  }
  return found;
}

}  // namespace quadcore
