#include "sdf_shape.hpp"

#include <cmath>

#include "extruded_polyline.hpp"
#include "quadcore/text.hpp"
#include "sdf_values.hpp"

namespace quadcore {
namespace {

using Element = Xml::Element;

constexpr double no_bounce = 1e5;  ///< default of the speed from which shapes bounce [m/s]

/// Return a length, which must be positive.
double length_or(const Xml& xml, const Element& shape, const char* name, double fallback) {
  const double length = number_or(xml, &shape, name, fallback);
  if (length > 0) return length;
  xml.fail(*descend(&shape, {name}), "<" + std::string(name) + "> is not positive. Correct it.");
}

/// Return a coefficient, which must not be negative. Stiffness exceeds the limit of other numbers.
double coefficient_or(const Xml& xml, const Element* parent, const char* name, double fallback) {
  const Element* e = descend(parent, {name});
  const std::string text = e ? xml.text(*e) : "";
  if (text.empty()) return fallback;
  const auto value = parse_number(text);
  if (value && *value >= 0) return *value;
  xml.fail(*e, "<" + std::string(name) + "> is '" + text + "'. Write a number >= 0.");
}

/// Read what a shape's surface contributes to a contact. A static body has no say in max_vel and
/// min_depth.
Surface read_surface(const Xml& xml, const Element& collision, bool is_static) {
  Surface surface;
  const Element* friction = descend(&collision, {"surface", "friction", "ode"});
  surface.mu1 = coefficient_or(xml, friction, "mu", surface.mu1);
  surface.mu2 = coefficient_or(xml, friction, "mu2", surface.mu2);
  const Element* direction = descend(friction, {"fdir1"});
  if (direction && !xml.text(*direction).empty()) {
    surface.fdir1 = xml.vector_in_text(*direction);
  }
  const Element* contact = descend(&collision, {"surface", "contact", "ode"});
  surface.kp = coefficient_or(xml, contact, "kp", surface.kp);
  surface.kd = coefficient_or(xml, contact, "kd", surface.kd);
  if (surface.kp == 0 && surface.kd == 0) {
    xml.fail(*contact, "<kp> and <kd> are both 0. Write a positive number for one of them.");
  }
  if (!is_static) {
    surface.max_vel = coefficient_or(xml, contact, "max_vel", surface.max_vel);
    surface.min_depth = coefficient_or(xml, contact, "min_depth", surface.min_depth);
  }
  const double points = number_or(xml, &collision, "max_contacts", surface.max_contacts);
  surface.max_contacts = static_cast<int>(std::min(std::max(points, 0.0), 1e6));
  return surface;
}

/// Record torsional friction, which is not modelled. It is in proportion to the radius of the patch
/// of contact, which is 0 by default.
void skip_torsional_friction(const Xml& xml, const Element& collision, const std::string& model) {
  const Element* torsional = descend(&collision, {"surface", "friction", "torsional"});
  const bool has_patch = number_or(xml, torsional, "patch_radius", 0) != 0 ||
                         number_or(xml, torsional, "surface_radius", 0) != 0;
  if (!has_patch || xml.ignored_elements().ignores({"torsional"})) return;
  xml.ignored_elements().add_unsimulated("torsional friction of " + model, xml.where(*torsional));
}

/// Set kind and extent of a shape with triangles.
void measure_mesh(Obstacle& shape) {
  shape.kind = ShapeKind::mesh;
  Vector3d least = shape.mesh->vertices.front().cast<double>(), most = least;
  for (const Eigen::Vector3f& vertex : shape.mesh->vertices) {
    least = least.cwiseMin(vertex.cast<double>());
    most = most.cwiseMax(vertex.cast<double>());
  }
  shape.size = most - least;
  shape.center = (least + most) / 2;
}

/// Returns whether the mesh is found.
bool read_mesh(const Xml& xml, const Element& mesh, const Vector3d& scale, EmbeddedMeshes& meshes,
               Obstacle& shape) {
  const Element* given = descend(&mesh, {"scale"});
  Vector3d own = Vector3d::Ones();
  if (given && !xml.text(*given).empty()) own = xml.vector_in_text(*given);
  if (!(own.cwiseAbs().minCoeff() > 0)) xml.fail(*given, "<scale> is 0. Correct it.");
  shape.mesh = meshes.find(mesh, own.cwiseProduct(scale));
  if (!shape.mesh) return false;
  measure_mesh(shape);
  return true;
}

/// Read a closed polygon that is extruded along z.
void read_polyline(const Xml& xml, const Element& polyline, const Vector3d& scale,
                   Obstacle& shape) {
  if (const Element* second = polyline.NextSiblingElement("polyline")) {
    xml.fail(*second, "a second <polyline>, which cuts a hole, is not supported. Use a mesh.");
  }
  std::vector<Eigen::Vector2d> points;
  for (const Element* e = polyline.FirstChildElement("point"); e;
       e = e->NextSiblingElement("point")) {
    const std::vector<std::string> words = split(xml.text(*e));
    const auto x = words.size() == 2 ? parse_number(words[0]) : std::nullopt;
    const auto y = words.size() == 2 ? parse_number(words[1]) : std::nullopt;
    if (!x || !y) xml.fail(*e, "<point> is '" + xml.text(*e) + "'. Write two numbers.");
    points.emplace_back(*x * scale.x(), *y * scale.y());
  }
  const double height = length_or(xml, polyline, "height", 1) * scale.z();
  std::optional<TriangleMesh> mesh = extrude_polyline(std::move(points), height);
  if (!mesh) xml.fail(polyline, "<polyline> crosses itself or has no area. Correct its points.");
  shape.mesh = std::make_shared<const TriangleMesh>(std::move(*mesh));
  measure_mesh(shape);
}

}  // namespace

std::optional<Obstacle> read_obstacle(const Xml& xml, const Element& collision,
                                      const std::string& model, const Vector3d& scale,
                                      bool is_static, EmbeddedMeshes& meshes) {
  const Element* geometry = descend(&collision, {"geometry"});
  const Element* kind = geometry ? geometry->FirstChildElement() : nullptr;
  if (!kind || kind->Name() == std::string("empty")) return {};
  const Element* contact = descend(&collision, {"surface", "contact"});
  if (is_true(xml, descend(contact, {"collide_without_contact"}))) return {};
  // Every other shape has the bits 0xffff.
  if (std::fmod(number_or(xml, contact, "collide_bitmask", 1), 65536.0) == 0) return {};

  Obstacle shape;
  shape.where = xml.where(*kind);
  const std::string name = kind->Name();
  if (name == "box") {
    shape.kind = ShapeKind::box;
    const Element* size = descend(kind, {"size"});
    if (size && !xml.text(*size).empty()) shape.size = xml.vector_in_text(*size);
    if (!(shape.size.minCoeff() > 0)) {
      xml.fail(size ? *size : *kind, "<size> is not positive. Correct it.");
    }
    shape.size = shape.size.cwiseProduct(scale);
  } else if (name == "sphere") {
    shape.kind = ShapeKind::sphere;
    shape.size = {length_or(xml, *kind, "radius", 1) * scale.maxCoeff(), 0, 0};
  } else if (name == "cylinder") {
    shape.kind = ShapeKind::cylinder;
    shape.size = {length_or(xml, *kind, "radius", 1) * std::max(scale.x(), scale.y()),
                  length_or(xml, *kind, "length", 1) * scale.z(), 0};
  } else if (name == "plane") {
    shape.kind = ShapeKind::plane;
    shape.size = Vector3d::UnitZ();
    const Element* normal = descend(kind, {"normal"});
    if (normal && !xml.text(*normal).empty()) shape.size = xml.vector_in_text(*normal);
    if (!(shape.size.norm() > 0)) {
      xml.fail(*normal, "<normal> is zero. Write a direction, such as 0 0 1.");
    }
  } else if (name == "mesh") {
    if (!read_mesh(xml, *kind, scale, meshes, shape)) {
      const std::string uri = mesh_uri(*kind);
      xml.ignored_elements().add_unsimulated(
          "the missing mesh " + (uri.empty() ? "" : uri + " ") + "of " + model, shape.where);
      return {};
    }
  } else if (name == "polyline") {
    read_polyline(xml, *kind, scale, shape);
  } else if (name == "heightmap") {
    xml.ignored_elements().add_unsimulated("the heightmap of " + model, shape.where);
    return {};
  } else {
    xml.fail(*kind, "an obstacle of the shape <" + name +
                        "> is not supported. Use box, sphere, cylinder, plane, polyline or mesh.");
  }
  shape.surface = read_surface(xml, collision, is_static);
  const Element* friction = descend(&collision, {"surface", "friction", "ode"});
  shape.slip1 = coefficient_or(xml, friction, "slip1", 0);
  shape.slip2 = coefficient_or(xml, friction, "slip2", 0);
  const Element* bounce = descend(&collision, {"surface", "bounce"});
  shape.restitution = coefficient_or(xml, bounce, "restitution_coefficient", 0);
  shape.restitution_speed = coefficient_or(xml, bounce, "threshold", no_bounce);
  skip_torsional_friction(xml, collision, model);
  return shape;
}

}  // namespace quadcore
