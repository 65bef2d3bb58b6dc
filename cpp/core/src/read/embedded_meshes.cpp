#include "embedded_meshes.hpp"

#include <cstdint>
#include <cstring>
#include <limits>
#include <unordered_map>
#include <vector>

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

constexpr int digits_per_number = 8;  // hexadecimal

/// Append 32 bits as hexadecimal digits, which are faster to read than decimal ones.
template <class Number>
void append_bits(Number number, std::string& text) {
  std::uint32_t bits = 0;
  static_assert(sizeof bits == sizeof number);
  std::memcpy(&bits, &number, sizeof bits);
  for (int shift = 28; shift >= 0; shift -= 4) text += "0123456789abcdef"[bits >> shift & 15u];
}

/// Reads the numbers of append_bits() from a text without copying it.
class NumberReader {
 public:
  NumberReader(const Xml& xml, const Element& e) : xml_(xml), e_(e) {
    at_ = e.GetText() ? e.GetText() : "";
  }
  template <class Number>
  bool next(Number& number) {
    if (!*at_) return false;
    std::uint32_t bits = 0;
    for (int i = 0; i < digits_per_number; ++i, ++at_) {
      const bool is_digit = *at_ >= '0' && *at_ <= '9';
      if (!is_digit && !(*at_ >= 'a' && *at_ <= 'f')) fail();
      bits = bits << 4 | static_cast<std::uint32_t>(is_digit ? *at_ - '0' : *at_ - 'a' + 10);
    }
    std::memcpy(&number, &bits, sizeof number);
    return true;
  }
  [[noreturn]] void fail() const { xml_.fail(e_, "the embedded mesh is damaged. Remove it."); }

 private:
  const Xml& xml_;
  const Element& e_;
  const char* at_;
};

/// Numbers the distinct vertices of a mesh in their order.
class VertexNumbers {
 public:
  std::uint32_t find(const Eigen::Vector3f& vertex, std::string& text) {
    std::string bits;
    for (const float coordinate : {vertex.x(), vertex.y(), vertex.z()})
      append_bits(coordinate, bits);
    const auto [at, is_new] = numbers_.emplace(bits, static_cast<std::uint32_t>(numbers_.size()));
    if (is_new) text += bits;
    return at->second;
  }

 private:
  std::unordered_map<std::string, std::uint32_t> numbers_;
};

TriangleMesh read_triangles(const Xml& xml, const Element& embedded) {
  TriangleMesh mesh;
  NumberReader vertices(xml, xml.required_child(embedded, "vertices"));
  for (Eigen::Vector3f v; vertices.next(v.x());) {
    if (!vertices.next(v.y()) || !vertices.next(v.z()) || !v.allFinite()) vertices.fail();
    mesh.vertices.push_back(v);
  }
  NumberReader indices(xml, xml.required_child(embedded, "triangles"));
  for (TriangleMesh::Triangle t; indices.next(t[0]);) {
    if (!indices.next(t[1]) || !indices.next(t[2])) indices.fail();
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
  VertexNumbers numbers;
  for (SubMesh& part : parts) {
    if (!wanted.empty() && part.name != wanted) continue;
    if (!wanted.empty() && is_centered(mesh)) center(part);
    std::vector<std::uint32_t> number_of;
    for (const Vector3d& v : part.vertices) {
      number_of.push_back(numbers.find(v.cast<float>(), vertices));
    }
    for (const TriangleMesh::Triangle& t : part.triangles) {
      for (const std::uint32_t index : t) append_bits(number_of[index], triangles);
    }
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
