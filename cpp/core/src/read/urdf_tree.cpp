#include "quadcore/urdf_tree.hpp"

#include <cmath>

#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"
#include "references.hpp"
#include "xml.hpp"

namespace quadcore {
namespace {

using Element = Xml::Element;

Pose read_origin(const Xml& xml, const Element& parent) {
  const Element* origin = xml.child(parent, "origin");
  if (!origin) return {};
  xml.attributes_alone(*origin, {"xyz", "rpy"});
  return {xml.vector(*origin, "xyz", Vector3d::Zero()),
          xml.vector(*origin, "rpy", Vector3d::Zero())};
}

Inertial read_inertial(const Xml& xml, const Element& element, const std::string& link,
                       std::vector<std::string>& warnings) {
  xml.only_attributes(element, {});
  xml.children(element, {"origin", "mass", "inertia"});
  Inertial inertial;
  inertial.pose = read_origin(xml, element);
  const Element& mass = xml.required_child(element, "mass");
  xml.attributes_alone(mass, {"value"});
  inertial.mass = xml.number(mass, "value");
  if (inertial.mass < 0) {
    xml.fail(mass, "link '" + link + "' has the mass " + mass.Attribute("value") +
                       ". Use a positive mass in kg.");
  }
  const Element& inertia = xml.required_child(element, "inertia");
  xml.attributes_alone(inertia, {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"});
  const auto moment = [&](const char* name) { return xml.number(inertia, name); };
  const double xx = moment("ixx"), yy = moment("iyy"), zz = moment("izz");
  const double xy = moment("ixy"), xz = moment("ixz"), yz = moment("iyz");
  inertial.inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;

  // Principal moments of a rigid body are non-negative and obey the triangle inequality. Thin discs
  // reach equality exactly, hence the tolerance.
  const Vector3d principal = inertial.principal_moments();
  const double tolerance = 1e-6 * principal.cwiseAbs().maxCoeff();
  if (principal.minCoeff() < -tolerance) {
    xml.fail(inertia, "link '" + link +
                          "' has a negative principal moment of inertia. Write a positive "
                          "semi-definite inertia in kg m^2.");
  }
  if (principal[0] + principal[1] < principal[2] - tolerance) {
    // The equations of motion remain well posed.
    warnings.push_back(
        xml.where(inertia) + ": link '" + link +
        "' has a physically impossible inertia, which is used as written: the maximum principal "
        "moment exceeds the sum of the other two. Correct ixx, iyy and izz.");
  }
  return inertial;
}

Collision read_collision(const Xml& xml, const Element& element) {
  xml.only_attributes(element, {"name"});
  xml.children(element, {"origin", "geometry", "verbose"});
  const Element& geometry = xml.required_child(element, "geometry");
  xml.only_attributes(geometry, {});
  const auto shapes = xml.children(geometry, {"box", "cylinder", "sphere", "mesh"});
  if (shapes.size() != 1)
    xml.fail(
        geometry,
        "<geometry> must contain exactly one shape. Keep one of box, cylinder, sphere and mesh.");
  const Element& shape = *shapes.front();
  const char* name = element.Attribute("name");
  Collision collision{ShapeKind::mesh, Vector3d::Zero(), read_origin(xml, element),
                      xml.where(shape), name ? name : ""};
  const std::string kind = shape.Name();
  if (kind == "mesh") {
    xml.attributes_alone(shape, {"filename", "scale"});
    return collision;
  }
  if (kind == "box") {
    xml.attributes_alone(shape, {"size"});
    xml.attribute(shape, "size");
    collision.kind = ShapeKind::box;
    collision.size = xml.vector(shape, "size", Vector3d::Zero());
  } else if (kind == "cylinder") {
    xml.attributes_alone(shape, {"radius", "length"});
    collision.kind = ShapeKind::cylinder;
    collision.size = {xml.number(shape, "radius"), xml.number(shape, "length"), 1};
  } else {
    xml.attributes_alone(shape, {"radius"});
    collision.kind = ShapeKind::sphere;
    collision.size = {xml.number(shape, "radius"), 1, 1};
  }
  if (collision.size.minCoeff() <= 0) {
    xml.fail(shape, "<" + kind + "> has a size that is not positive. Use positive lengths in m.");
  }
  return collision;
}

UrdfLink read_link(const Xml& xml, const Element& element, std::vector<std::string>& warnings) {
  UrdfLink link;
  xml.only_attributes(element, {"name"});
  link.name = xml.attribute(element, "name");
  link.where = xml.where(element);
  for (const Element* child :
       xml.children(element, {"inertial", "visual", "collision"}, {"visual", "collision"})) {
    const std::string kind = child->Name();
    if (kind == "inertial") link.inertial = read_inertial(xml, *child, link.name, warnings);
    if (kind == "collision") link.collisions.push_back(read_collision(xml, *child));
  }
  return link;
}

/// A revolute joint without travel is locked; one that can turn is not modelled.
void check_locked(const Xml& xml, const Element& element, const std::string& name) {
  const Element* limit = xml.child(element, "limit");
  if (limit) {
    xml.attributes_alone(*limit, {"effort", "velocity", "lower", "upper"});
    if (xml.number(*limit, "lower", 0) == 0 && xml.number(*limit, "upper", 0) == 0) return;
  }
  xml.fail(limit ? *limit : element,
           "joint '" + name +
               "' is of type 'revolute' with a range of travel, which the engines do not model. "
               "Use continuous or fixed, or lock it with lower=\"0\" upper=\"0\".");
}

UrdfJoint read_joint(const Xml& xml, const Element& element, std::vector<std::string>& warnings) {
  UrdfJoint joint;
  xml.only_attributes(element, {"name", "type"});
  joint.name = xml.attribute(element, "name");
  joint.where = xml.where(element);
  const std::string type = xml.attribute(element, "type");
  if (type != "fixed" && type != "continuous" && type != "revolute") {
    xml.fail(element, "joint '" + joint.name + "' is of type '" + type +
                          "', which the engines do not model. Use continuous or fixed.");
  }
  joint.locked = type == "revolute";
  joint.fixed = type == "fixed" || joint.locked;
  // <mimic>, <safety_controller> and <calibration> would change the motion and are not modelled.
  xml.children(element, {"origin", "parent", "child", "axis", "dynamics", "limit"});
  const auto linked = [&](const char* role) {
    const Element& end = xml.required_child(element, role);
    xml.attributes_alone(end, {"link"});
    return xml.attribute(end, "link");
  };
  joint.parent = linked("parent");
  joint.child = linked("child");
  joint.pose = read_origin(xml, element);
  if (joint.locked) check_locked(xml, element, joint.name);
  if (type == "fixed") return joint;

  if (const Element* axis = xml.child(element, "axis")) {
    xml.attributes_alone(*axis, {"xyz"});
    joint.axis = xml.vector(*axis, "xyz", Vector3d::UnitX());
    if (!joint.locked && !(joint.axis.norm() > 1e-9)) {
      xml.fail(*axis,
               "joint '" + joint.name + "' has a zero axis. Write a direction such as 0 0 1.");
    }
  }
  if (joint.locked) return joint;
  if (const Element* dynamics = xml.child(element, "dynamics")) {
    xml.attributes_alone(*dynamics, {"damping", "friction"});
    joint.damping = xml.number(*dynamics, "damping", 0);
    if (joint.damping < 0) {
      xml.fail(*dynamics,
               "joint '" + joint.name + "' has a negative damping. Use a value >= 0 in N m s/rad.");
    }
    joint.friction = xml.number(*dynamics, "friction", 0);
    if (joint.friction < 0) {
      xml.fail(*dynamics,
               "joint '" + joint.name + "' has a negative friction. Use a value >= 0 in N m.");
    }
  }
  if (const Element* limit = xml.child(element, "limit")) {
    xml.attributes_alone(*limit, {"effort", "velocity", "lower", "upper"});
    for (const char* without_effect : {"effort", "velocity"}) {
      xml.number(*limit, without_effect, 0);
    }
    for (const char* bound : {"lower", "upper"}) {
      if (xml.number(*limit, bound, 0) != 0) {
        xml.fail(*limit, "joint '" + joint.name + "' has a limit " + bound +
                             ", which the engines do not model. Remove it.");
      }
    }
    warnings.push_back(
        xml.where(*limit) + ": joint '" + joint.name +
        "': effort and velocity limits of a continuous joint have no effect, as in Gazebo.");
  }
  return joint;
}

void read_plugin_tag(const Xml& xml, const Element& tag, const std::string& outer,
                     PluginElement& plugin);

/// Nested tags are named by both elements: outer/inner.
void read_plugin_tags(const Xml& xml, const Element& element, const std::string& outer,
                      PluginElement& plugin) {
  for (const auto* node = element.FirstChild(); node; node = node->NextSibling()) {
    if (node->ToText()) {
      xml.fail(element, "stray text '" + trimmed(node->Value()) + "' in <plugin name=\"" +
                            plugin.name + "\">. Write <tag>value</tag>.");
    }
    if (const Element* tag = node->ToElement()) read_plugin_tag(xml, *tag, outer, plugin);
  }
}

void read_plugin_tag(const Xml& xml, const Element& tag, const std::string& outer,
                     PluginElement& plugin) {
  const std::string name = outer + tag.Name();
  if (tag.FirstChildElement()) {
    if (tag.Attribute("type")) {
      plugin.tags.push_back({name + "/type", xml.attribute(tag, "type"), xml.where(tag)});
    }
    read_plugin_tags(xml, tag, name + "/", plugin);
  } else {
    plugin.tags.push_back({name, xml.text(tag), xml.where(tag)});
  }
}

PluginElement read_plugin(const Xml& xml, const Element& element) {
  xml.only_attributes(element, {"name", "filename"});
  PluginElement plugin{
      xml.attribute(element, "name"), xml.attribute(element, "filename"), {}, xml.where(element)};
  try {
    read_plugin_tags(xml, element, "", plugin);
  } catch (const InputError& error) {
    plugin.fault = error.what();  // raised only if the module is loaded
  }
  return plugin;
}

/// Modules inside a Gazebo sensor, which take the sensor's elements as tags: sensor/...
const std::set<std::string> carried_by_sensors = {"librotors_gazebo_gps_plugin.so"};

/// Skip a sensor unless it contains such a module.
void read_sensor(const Xml& xml, const Element& sensor, UrdfTree& tree) {
  if (xml.ignored_elements().ignores({"sensor"})) return;
  for (const Element* child = sensor.FirstChildElement("plugin"); child;
       child = child->NextSiblingElement("plugin")) {
    const char* const filename = child->Attribute("filename");
    if (!filename || !carried_by_sensors.count(filename)) continue;
    PluginElement plugin = read_plugin(xml, *child);
    if (xml.ignored_elements().ignores({plugin.name, plugin.filename})) return;
    for (const Element* tag = sensor.FirstChildElement(); tag; tag = tag->NextSiblingElement()) {
      if (std::string(tag->Name()) != "plugin") read_plugin_tag(xml, *tag, "sensor/", plugin);
    }
    return tree.plugins.push_back(std::move(plugin));
  }
  xml.ignored_elements().add_harmless("<sensor>", xml.where(sensor));
}

void read_gazebo(const Xml& xml, const Element& element, UrdfTree& tree) {
  xml.only_attributes(element, {"reference", "name"});
  if (element.Attribute("reference")) {
    tree.references.push_back(read_reference(xml, element));
    for (const Element* sensor = element.FirstChildElement("sensor"); sensor;
         sensor = sensor->NextSiblingElement("sensor")) {
      read_sensor(xml, *sensor, tree);
    }
    return;
  }
  for (const Element* child : xml.children(element, {"plugin"}, {"plugin"})) {
    PluginElement plugin = read_plugin(xml, *child);
    if (xml.ignored_elements().ignores({plugin.name, plugin.filename})) continue;
    tree.plugins.push_back(std::move(plugin));
  }
}

}  // namespace

UrdfTree read_urdf_tree(const Document& document, const std::vector<std::string>& ignore) {
  UrdfTree tree;
  tree.ignored_elements = IgnoredElements(ignore);
  const Xml xml(document, "robot", tree.ignored_elements);
  xml.only_attributes(xml.root(), {"name", "version"});
  tree.name = xml.attribute(xml.root(), "name");
  tree.where = xml.where(xml.root());
  const std::set<std::string> elements = {"link", "joint", "gazebo", "material", "plugin"};
  for (const Element* element : xml.children(xml.root(), elements, elements)) {
    const std::string kind = element->Name();
    if (kind == "plugin") {
      xml.fail(*element, "<plugin> stands outside <gazebo>. Wrap it in <gazebo>...</gazebo>.");
    } else if (kind == "link") {
      tree.links.push_back(read_link(xml, *element, tree.warnings));
    } else if (kind == "joint") {
      tree.joints.push_back(read_joint(xml, *element, tree.warnings));
    } else if (kind == "gazebo") {
      read_gazebo(xml, *element, tree);
    }
  }
  return tree;
}

}  // namespace quadcore
