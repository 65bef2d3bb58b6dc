#include "quadcore/gazebo_reference.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "quadcore/text.hpp"
#include "references.hpp"

namespace quadcore {
namespace {

using Element = Xml::Element;

enum class Kind { number, whole, flag, vector, anything };

/// Type and range of a value.
struct Values {
  Kind kind;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open = false;  ///< min itself is out of range

  std::string range() const {
    std::ostringstream text;
    switch (kind) {
      case Kind::flag:
        if (min == 1) return "true";
        return max == 0 ? "false" : "true | false";
      case Kind::vector:
        return "three numbers";
      case Kind::anything:
        return "";
      default:
        break;
    }
    if (min == max) {
      text << min;
      return text.str();
    }
    if (kind == Kind::whole) text << "whole number ";
    if (std::isfinite(min)) text << (open ? "> " : ">= ") << min;
    if (std::isfinite(max)) text << ", <= " << max;
    return text.str().empty() ? "any finite number" : text.str();
  }

  bool hold(double value) const {
    return value >= min && value <= max && !(open && value == min) &&
           (kind != Kind::whole || value == std::floor(value));
  }
};

struct Entry {
  GazeboTag tag;
  Values values;
};

const std::vector<Entry>& table() {
  const Values number{Kind::number},
      positive{Kind::number, 0, std::numeric_limits<double>::infinity(), true},
      not_negative{Kind::number, 0}, part{Kind::number, 0, 1}, none{Kind::number, 0, 0},
      count{Kind::whole, 1, 1000}, flag{Kind::flag, 0, 1}, on{Kind::flag, 1, 1},
      off{Kind::flag, 0, 0}, vector{Kind::vector}, anything{Kind::anything};
  static const std::vector<Entry> entries = {
      {{"mu1", "link", "shapes", "", "1", "",
        "friction coefficient along fdir1; the smaller one of the pair counts, the ground has 100"},
       not_negative},
      {{"mu2", "link", "shapes", "", "1", "",
        "friction coefficient across fdir1; the smaller one of the pair counts, the ground has 50"},
       not_negative},
      {{"fdir1", "link", "shapes", "", "0 0 0", "",
        "direction of mu1 in the shape's axes, not normalised; 0 0 0: the world's -y"},
       vector},
      {{"kp", "link", "shapes", "N/m", "1e12", "", "stiffness, in series with the ground's 1e12"},
       positive},
      {{"kd", "link", "shapes", "N s/m", "1", "", "damping, added to the ground's 1"},
       not_negative},
      {{"minDepth", "link", "shapes", "m", "0", "",
        "penetration that is not corrected; the body's last shape counts"},
       not_negative},
      {{"maxVel", "link", "shapes", "m/s", "0.01", "",
        "maximum velocity that remains after a correction; the body's last shape counts"},
       not_negative},
      {{"maxContacts", "link", "shapes", "", "10", "",
        "maximum number of contact points of a shape, at most 10"},
       count},
      {{"dampingFactor", "link", "body", "", "0", "",
        "fraction of the velocity that the body loses in each step above 0.01 m/s or 0.01 rad/s"},
       part},
      {{"turnGravityOff", "link", "body", "", "false", "", "disables gravity for the body"}, flag},
      {{"implicitSpringDamper", "joint", "joint", "", "false", "",
        "applies the joint's damping as a constraint instead of a torque"},
       flag},
      {{"selfCollide", "link", "", "", "", "", "links of the same model do not collide"}, flag},
      {{"gravity", "link", "", "", "", "", "use turnGravityOff"}, on},
      {{"static", "link", "", "", "", "", "a vehicle is never static"}, off},
      {{"velocity_decay", "link", "", "", "", "", "use dampingFactor"}, anything},
      {{"material", "link", "", "", "", "", "appearance only"}, anything},
      {{"visual", "link", "", "", "", "", "appearance only"}, anything},
      {{"stopErp", "joint", "", "", "", "", "for joint stops, which a rotor lacks"}, number},
      {{"stopCfm", "joint", "", "", "", "", "for joint stops, which a rotor lacks"}, number},
      {{"fudgeFactor", "joint", "", "", "", "", "for joint stops, which a rotor lacks"}, number},
      {{"springStiffness", "joint", "", "", "", "", "joint springs are not modelled"}, none},
  };
  return entries;
}

/// Gazebo accepts `value="..."` as well as text.
std::string text_of(const Xml& xml, const Element& element) {
  if (!element.Attribute("value")) return xml.text(element);
  xml.attributes_alone(element, {"value"});
  return xml.attribute(element, "value");
}

Vector3d read_value(const Xml& xml, const Element& element, const Entry& entry) {
  const std::string text = text_of(xml, element);
  const auto refuse = [&]() {
    xml.fail(element,
             "<" + entry.tag.name + "> is '" + text + "'. Use " + entry.values.range() + ".");
  };
  if (entry.values.kind == Kind::vector) {
    const auto value = parse_vector(text);
    if (!value) refuse();
    return *value;
  }
  std::string word = text;
  if (entry.values.kind == Kind::flag) {
    const std::string small = lower(text);
    if (small == "true" || small == "yes") word = "1";
    if (small == "false" || small == "no") word = "0";
  }
  const auto value = parse_number(word);
  if (!value || !entry.values.hold(*value)) refuse();
  if (entry.values.kind == Kind::flag && *value != 0 && *value != 1) refuse();
  return {*value, 0, 0};
}

}  // namespace

std::vector<GazeboTag> gazebo_tags() {
  std::vector<GazeboTag> tags;
  for (const Entry& entry : table()) {
    tags.push_back(entry.tag);
    tags.back().range = entry.values.range();
  }
  return tags;
}

GazeboReference read_reference(const Xml& xml, const Element& element) {
  GazeboReference reference{xml.attribute(element, "reference"), xml.where(element), {}};
  // read_sensor() reads the sensors.
  std::set<std::string> names = {"sensor"}, repeatable = names;
  for (const Entry& entry : table()) {
    names.insert(entry.tag.name);
    if (entry.values.kind == Kind::anything) repeatable.insert(entry.tag.name);
  }
  for (const Element* child : xml.children(element, names, repeatable)) {
    for (const Entry& entry : table()) {
      if (entry.tag.name != child->Name() || entry.values.kind == Kind::anything) continue;
      const Vector3d value = read_value(xml, *child, entry);
      if (!entry.tag.affects.empty()) {
        reference.tags.push_back({entry.tag.name, value, xml.where(*child)});
      }
    }
  }
  return reference;
}

}  // namespace quadcore
