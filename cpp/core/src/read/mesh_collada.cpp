#include <tinyxml2.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "mesh_file.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

using Element = tinyxml2::XMLElement;

constexpr int deepest_node = 100;
constexpr std::size_t most_triangles = 10000000;

std::string attribute(const Element& e, const char* name) {
  const char* value = e.Attribute(name);
  return value ? value : "";
}

/// Return the numbers in an element, up to the first word that is none.
std::vector<double> numbers_in(const Element* e) {
  std::vector<double> numbers;
  const char* at = e && e->GetText() ? e->GetText() : "";
  for (char* end = nullptr;; at = end) {
    const double number = std::strtod(at, &end);
    if (end == at) return numbers;
    numbers.push_back(number);
  }
}

/// Reads the triangles of a scene: COLLADA 1.4, chapter 5 (geometry) and 5.8 (nodes).
class ColladaReader {
 public:
  ColladaReader(const std::string& path, const std::string& content) : path_(path) {
    if (xml_.Parse(content.data(), content.size()) != tinyxml2::XML_SUCCESS) {
      refuse_mesh(path, "malformed XML");
    }
    const Element* root = xml_.FirstChildElement("COLLADA");
    if (!root) refuse_mesh(path, "the outermost element is not <COLLADA>");
    collect_ids(*root, 0);
    const Element* asset = root->FirstChildElement("asset");
    const Element* unit = asset ? asset->FirstChildElement("unit") : nullptr;
    if (unit && unit->Attribute("meter")) {
      const auto meter = parse_number(attribute(*unit, "meter"));
      if (!meter || !(*meter > 0)) refuse_mesh(path, "the unit is not positive");
      meter_ = *meter;
    }
    const Element* scene = root->FirstChildElement("scene");
    scene = scene ? scene->FirstChildElement("instance_visual_scene") : nullptr;
    if (!scene) refuse_mesh(path, "the file has no scene");
    const Element& visual = find(attribute(*scene, "url"), "visual_scene");
    for (const auto* e = visual.FirstChildElement("node"); e; e = e->NextSiblingElement("node")) {
      read_node(*e, Eigen::Matrix4d::Identity(), 0);
    }
  }

  std::vector<SubMesh> parts() { return std::move(parts_); }

 private:
  void collect_ids(const Element& parent, int depth) {
    if (depth > deepest_node) refuse_mesh(path_, "its elements are nested too deeply");
    for (const auto* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (const char* id = e->Attribute("id")) ids_.emplace(id, e);
      collect_ids(*e, depth + 1);
    }
  }

  /// Return the element of a URL "#ID".
  const Element& find(const std::string& url, const char* name) const {
    const auto found = ids_.find(url.empty() ? url : url.substr(1));
    if (found == ids_.end() || found->second->Name() != std::string(name)) {
      refuse_mesh(path_, "<" + std::string(name) + "> '" + url + "' does not exist");
    }
    return *found->second;
  }

  Eigen::Matrix4d transform_of(const Element& node) const {
    Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
    for (const auto* e = node.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string kind = e->Name();
      const bool known =
          kind == "matrix" || kind == "translate" || kind == "rotate" || kind == "scale";
      if (!known) continue;
      const std::vector<double> n = numbers_in(e);
      const std::size_t expected = kind == "matrix" ? 16 : kind == "rotate" ? 4 : 3;
      if (n.size() != expected) refuse_mesh(path_, "<" + kind + "> has too few numbers");
      Eigen::Matrix4d step = Eigen::Matrix4d::Identity();
      if (kind == "matrix") {
        step = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(n.data());
      } else if (kind == "translate") {
        step.topRightCorner<3, 1>() = Vector3d(n[0], n[1], n[2]);
      } else if (kind == "rotate") {
        const Vector3d axis = Vector3d(n[0], n[1], n[2]).normalized();
        const elementary::SineCosine half = elementary::sincos(n[3] * M_PI / 360);
        const Vector3d v = half.sin * axis;
        const Quaterniond turn(half.cos, v.x(), v.y(), v.z());
        step.topLeftCorner<3, 3>() = turn.toRotationMatrix();
      } else {
        step.topLeftCorner<3, 3>() = Vector3d(n[0], n[1], n[2]).asDiagonal();
      }
      transform = transform * step;
    }
    return transform;
  }

  void read_node(const Element& node, const Eigen::Matrix4d& parent, int depth) {
    if (depth > deepest_node) refuse_mesh(path_, "a node contains itself");
    const Eigen::Matrix4d transform = parent * transform_of(node);
    if (node.Attribute("name")) name_ = attribute(node, "name");
    for (const auto* e = node.FirstChildElement("node"); e; e = e->NextSiblingElement("node")) {
      read_node(*e, transform, depth + 1);
    }
    for (const auto* e = node.FirstChildElement("instance_node"); e;
         e = e->NextSiblingElement("instance_node")) {
      read_node(find(attribute(*e, "url"), "node"), transform, depth + 1);
    }
    for (const auto* e = node.FirstChildElement("instance_geometry"); e;
         e = e->NextSiblingElement("instance_geometry")) {
      read_geometry(find(attribute(*e, "url"), "geometry"), transform);
    }
    for (const auto* e = node.FirstChildElement("instance_controller"); e;
         e = e->NextSiblingElement("instance_controller")) {
      const Element& controller = find(attribute(*e, "url"), "controller");
      const Element* skin = controller.FirstChildElement("skin");
      if (skin) read_geometry(find(attribute(*skin, "source"), "geometry"), transform);
    }
  }

  void read_geometry(const Element& geometry, const Eigen::Matrix4d& transform) {
    const Element* mesh = geometry.FirstChildElement("mesh");
    if (!mesh) return;
    for (const char* kind : {"triangles", "polylist", "polygons"}) {
      for (const auto* e = mesh->FirstChildElement(kind); e; e = e->NextSiblingElement(kind)) {
        read_faces(*e, transform);
      }
    }
  }

  std::vector<Vector3d> read_positions(const Element& vertices, const Eigen::Matrix4d& transform) {
    for (const auto* e = vertices.FirstChildElement("input"); e;
         e = e->NextSiblingElement("input")) {
      if (attribute(*e, "semantic") != "POSITION") continue;
      const Element& source = find(attribute(*e, "source"), "source");
      const std::vector<double> n = numbers_in(source.FirstChildElement("float_array"));
      std::vector<Vector3d> positions;
      for (std::size_t i = 0; i + 2 < n.size(); i += 3) {
        const Eigen::Vector4d p = transform * Eigen::Vector4d(n[i], n[i + 1], n[i + 2], 1);
        positions.push_back(meter_ * p.head<3>());
      }
      return positions;
    }
    refuse_mesh(path_, "<vertices> has no positions");
  }

  /// Read `<triangles>`, `<polylist>` or `<polygons>`.
  void read_faces(const Element& faces, const Eigen::Matrix4d& transform) {
    SubMesh part;
    part.name = name_;
    std::size_t stride = 0, offset = 0;
    for (const auto* e = faces.FirstChildElement("input"); e; e = e->NextSiblingElement("input")) {
      const int at = e->IntAttribute("offset");
      if (at < 0 || at > deepest_node) refuse_mesh(path_, "an offset is out of range");
      stride = std::max(stride, static_cast<std::size_t>(at) + 1);
      if (attribute(*e, "semantic") != "VERTEX") continue;
      offset = static_cast<std::size_t>(at);
      part.vertices = read_positions(find(attribute(*e, "source"), "vertices"), transform);
    }
    if (part.vertices.empty()) return;
    const std::vector<double> counts = numbers_in(faces.FirstChildElement("vcount"));
    const bool is_polygons = faces.Name() == std::string("polygons");
    std::size_t next_count = 0;
    for (const auto* e = faces.FirstChildElement("p"); e; e = e->NextSiblingElement("p")) {
      const std::vector<double> indices = numbers_in(e);
      for (std::size_t begin = 0; begin < indices.size();) {
        std::size_t corners = 3;
        if (is_polygons) corners = indices.size() / stride;
        if (!counts.empty() && next_count < counts.size()) {
          const double count = counts[next_count++];
          if (!(count >= 1 && count < most_triangles)) refuse_mesh(path_, "<vcount> is wrong");
          corners = static_cast<std::size_t>(count);
        }
        if (corners == 0 || begin + corners * stride > indices.size()) {
          refuse_mesh(path_, "<p> ends within a face");
        }
        add_face(indices, begin + offset, corners, stride, part);
        begin += corners * stride;
      }
    }
    parts_.push_back(std::move(part));
  }

  void add_face(const std::vector<double>& indices, std::size_t first, std::size_t corners,
                std::size_t stride, SubMesh& part) {
    const auto vertex = [&](std::size_t corner) {
      const double index = indices[first + corner * stride];
      const bool exists = index >= 0 && index < static_cast<double>(part.vertices.size());
      if (!exists) refuse_mesh(path_, "a triangle names a missing vertex");
      return static_cast<std::uint32_t>(index);
    };
    for (std::size_t i = 2; i < corners; ++i) {
      if (++count_ > most_triangles) refuse_mesh(path_, "the scene exceeds 10 million triangles");
      part.triangles.push_back({vertex(0), vertex(i - 1), vertex(i)});
    }
  }

  std::string path_;
  tinyxml2::XMLDocument xml_;
  std::map<std::string, const Element*> ids_;
  double meter_ = 1;
  std::string name_;
  std::size_t count_ = 0;
  std::vector<SubMesh> parts_;
};

}  // namespace

std::vector<SubMesh> read_collada(const std::string& path, const std::string& content) {
  return ColladaReader(path, content).parts();
}

}  // namespace quadcore
