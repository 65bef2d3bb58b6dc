#include "sdf_shape.hpp"

#include <cmath>

#include "quadcore/text.hpp"

namespace quadcore {
namespace {

using Element = Xml::Element;

const Element* descend(const Element* e, std::initializer_list<const char*> names) {
  for (const char* name : names) e = e ? e->FirstChildElement(name) : nullptr;
  return e;
}

double number_or(const Xml& xml, const Element* parent, const char* name, double fallback) {
  const Element* e = descend(parent, {name});
  return e && !xml.text(*e).empty() ? xml.number_in_text(*e) : fallback;
}

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

/// Read what a static shape's surface contributes to a contact. Bounce needs both shapes to have
/// it, and a static body has no say in max_vel and min_depth.
Surface read_static_surface(const Xml& xml, const Element& collision) {
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
  const double points = number_or(xml, &collision, "max_contacts", surface.max_contacts);
  surface.max_contacts = static_cast<int>(std::min(std::max(points, 0.0), 1e6));
  return surface;
}

/// Reject torsional friction, which is not modelled, unless the user ignores it. It is in
/// proportion to the radius of the patch of contact, which is 0 by default.
void refuse_torsional_friction(const Xml& xml, const Element& collision) {
  const Element* torsional = descend(&collision, {"surface", "friction", "torsional"});
  const bool has_patch = number_or(xml, torsional, "patch_radius", 0) != 0 ||
                         number_or(xml, torsional, "surface_radius", 0) != 0;
  if (!has_patch || xml.ignored_elements().ignores({"torsional"})) return;
  xml.fail(*torsional, "<torsional> is not supported. Remove it." + suggest_ignoring("torsional"));
}

bool is_true(const Xml& xml, const Element* e) {
  return e && (xml.text(*e) == "1" || xml.text(*e) == "true");
}

}  // namespace

std::optional<Obstacle> read_obstacle(const Xml& xml, const Element& collision,
                                      const Vector3d& scale) {
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
    shape.kind = ObstacleKind::box;
    const Element* size = descend(kind, {"size"});
    if (size && !xml.text(*size).empty()) shape.size = xml.vector_in_text(*size);
    if (!(shape.size.minCoeff() > 0)) {
      xml.fail(size ? *size : *kind, "<size> is not positive. Correct it.");
    }
    shape.size = shape.size.cwiseProduct(scale);
  } else if (name == "sphere") {
    shape.kind = ObstacleKind::sphere;
    shape.size = {length_or(xml, *kind, "radius", 1) * scale.maxCoeff(), 0, 0};
  } else if (name == "cylinder") {
    shape.kind = ObstacleKind::cylinder;
    shape.size = {length_or(xml, *kind, "radius", 1) * std::max(scale.x(), scale.y()),
                  length_or(xml, *kind, "length", 1) * scale.z(), 0};
  } else if (name == "plane") {
    shape.kind = ObstacleKind::plane;
    shape.size = Vector3d::UnitZ();
    const Element* normal = descend(kind, {"normal"});
    if (normal && !xml.text(*normal).empty()) shape.size = xml.vector_in_text(*normal);
    if (!(shape.size.norm() > 0)) {
      xml.fail(*normal, "<normal> is zero. Write a direction, such as 0 0 1.");
    }
  } else {
    xml.fail(*kind, "an obstacle of the shape <" + name +
                        "> is not supported. Use box, sphere, cylinder or plane.");
  }
  shape.surface = read_static_surface(xml, collision);
  const Element* friction = descend(&collision, {"surface", "friction", "ode"});
  shape.slip1 = coefficient_or(xml, friction, "slip1", 0);
  shape.slip2 = coefficient_or(xml, friction, "slip2", 0);
  refuse_torsional_friction(xml, collision);
  return shape;
}

}  // namespace quadcore
