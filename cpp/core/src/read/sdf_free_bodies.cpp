#include "sdf_free_bodies.hpp"

#include <algorithm>

#include "quadcore/text.hpp"
#include "sdf_values.hpp"
#include "sdf_version.hpp"

namespace quadcore {
namespace {

using Element = Xml::Element;

std::string attribute_of(const Element& element, const char* name) {
  const char* value = element.Attribute(name);
  return value ? trimmed(value) : "";
}

/// Return the text of a child, or "".
std::string text_of(const Xml& xml, const Element& parent, const char* name) {
  const Element* e = xml.child(parent, name);
  return e ? xml.text(*e) : "";
}

/// Read the inertia of a link; what the file lacks is 1 kg and 1 kg m^2, as in Gazebo.
Inertial read_inertial(const Xml& xml, const Element& link) {
  Inertial inertial;
  inertial.mass = 1;
  inertial.inertia = Matrix3d::Identity();
  const Element* given = xml.child(link, "inertial");
  if (!given) return inertial;
  inertial.mass = number_or(xml, given, "mass", 1);
  if (const Element* pose = xml.child(*given, "pose")) {
    const Placement placement = read_placement(xml, *pose);
    inertial.pose.xyz = placement.position;
    inertial.pose.rpy = rpy_from_quaternion(placement.rotation);
  }
  if (const Element* moments = xml.child(*given, "inertia")) {
    const double xy = number_or(xml, moments, "ixy", 0), xz = number_or(xml, moments, "ixz", 0);
    const double yz = number_or(xml, moments, "iyz", 0);
    inertial.inertia << number_or(xml, moments, "ixx", 1), xy, xz,  //
        xy, number_or(xml, moments, "iyy", 1), yz,                  //
        xz, yz, number_or(xml, moments, "izz", 1);
  }
  if (!(inertial.mass > 0) || !inertial.is_positive()) {
    xml.fail(*given, "the mass or a moment of inertia of the link '" + attribute_of(link, "name") +
                         "' is not positive. Correct it.");
  }
  return inertial;
}

const JointedLink* find_link(const Xml& xml, const Element& joint, const char* end,
                             const std::vector<JointedLink>& links) {
  const std::string name = text_of(xml, joint, end);
  if (name == "world") return nullptr;
  const auto found = std::find_if(links.begin(), links.end(),
                                  [&](const JointedLink& link) { return link.name == name; });
  if (found != links.end()) return &*found;
  xml.fail(joint, "the joint '" + attribute_of(joint, "name") + "' has the " + end + " '" + name +
                      "', which is no link that moves. Correct its name.");
}

FreeJointKind read_kind(const Xml& xml, const Element& joint) {
  const std::string type = attribute_of(joint, "type");
  if (type == "fixed") return FreeJointKind::fixed;
  if (type == "revolute" || type == "continuous") return FreeJointKind::revolute;
  if (type == "prismatic") return FreeJointKind::prismatic;
  if (type == "universal") return FreeJointKind::universal;
  if (type == "ball") return FreeJointKind::ball;
  xml.fail(joint, "a joint of type '" + type +
                      "' is not supported. Use fixed, revolute, prismatic, universal or ball.");
}

/// Return the direction of an axis in the model.
Vector3d read_axis(const Xml& xml, const Element& joint, const char* name, const Placement& X_MJ,
                   const SdfFrames& frames) {
  const Element* axis = xml.child(joint, name);
  const Element* xyz = axis ? xml.child(*axis, "xyz") : nullptr;
  if (!xyz) return X_MJ.rotation * Vector3d::UnitZ();
  const std::string text = xml.text(*xyz, {"expressed_in"});
  const std::optional<Vector3d> given = parse_vector(text);
  if (text.empty()) return X_MJ.rotation * Vector3d::UnitZ();
  if (!given || !(given->norm() > 0)) {
    xml.fail(*xyz, "<xyz> is '" + text + "'. Write three numbers that are not all 0.");
  }
  const Vector3d direction = given->normalized();
  const bool is_in_model = is_true(xml, xml.child(*axis, "use_parent_model_frame"));
  if (is_in_model || is_at_most_sdf(xml, joint, 4)) return direction;
  const std::string frame = attribute_of(*xyz, "expressed_in");
  return (frame.empty() ? X_MJ : frames.find_frame(*xyz, frame)).rotation * direction;
}

/// Return a limit, which may be infinite.
double limit_or(const Xml& xml, const Element* limit, const char* name, double fallback) {
  const Element* e = xml.child(*limit, name);
  const std::string text = e ? lower(xml.text(*e)) : "";
  if (text.empty() || text == "inf" || text == "-inf") return fallback;
  const auto value = parse_number(text);
  if (!value) xml.fail(*e, "<" + std::string(name) + "> is '" + text + "'. Write a number.");
  return *value;
}

/// Read what acts along the first axis of a joint.
void read_dynamics(const Xml& xml, const Element& joint, FreeJoint& result) {
  const Element* axis = xml.child(joint, "axis");
  if (!axis) return;
  if (const Element* dynamics = xml.child(*axis, "dynamics")) {
    result.damping = number_or(xml, dynamics, "damping", 0);
    result.friction = number_or(xml, dynamics, "friction", 0);
    result.stiffness = number_or(xml, dynamics, "spring_stiffness", 0);
    result.rest_position = number_or(xml, dynamics, "spring_reference", 0);
    if (!(result.damping >= 0 && result.friction >= 0 && result.stiffness >= 0)) {
      xml.fail(*dynamics, "damping, friction or stiffness is negative. Correct it.");
    }
  }
  if (const Element* limit = xml.child(*axis, "limit")) {
    result.lower = limit_or(xml, limit, "lower", result.lower);
    result.upper = limit_or(xml, limit, "upper", result.upper);
    if (result.lower > result.upper) {
      xml.fail(*limit, "<lower> exceeds <upper>. Correct them.");
    }
  }
}

/// Refuse limits and forces about axes for which only revolute and prismatic joints have rows.
void refuse_dynamics(const Xml& xml, const Element& joint, const FreeJoint& result) {
  if (result.kind == FreeJointKind::revolute || result.kind == FreeJointKind::prismatic) return;
  if (result.kind == FreeJointKind::fixed) return;
  constexpr double unlimited = 1e9;
  const bool is_limited = result.lower > -unlimited || result.upper < unlimited;
  if (!is_limited && result.damping == 0 && result.friction == 0 && result.stiffness == 0) return;
  xml.fail(joint, "limits, damping, friction and springs of a joint of type '" +
                      attribute_of(joint, "type") + "' are not supported. Remove them.");
}

}  // namespace

FreeBody read_free_body(const Xml& xml, const Element& link) {
  FreeBody body;
  body.name = attribute_of(link, "name");
  body.where = xml.where(link);
  body.inertial = read_inertial(xml, link);
  const Element* gravity = xml.child(link, "gravity");
  body.gravity = !gravity || xml.text(*gravity).empty() || is_true(xml, gravity);
  if (is_true(xml, xml.child(link, "kinematic"))) {
    xml.fail(*xml.child(link, "kinematic"), "a kinematic link is not supported. Remove it.");
  }
  body.may_sleep = !xml.child(link, "sensor");
  if (const Element* decay = xml.child(link, "velocity_decay")) {
    body.linear_decay = number_or(xml, decay, "linear", 0);
    body.angular_decay = number_or(xml, decay, "angular", 0);
  }
  return body;
}

FreeJoint read_free_joint(const Xml& xml, const Element& joint,
                          const std::vector<JointedLink>& links, const SdfFrames& frames,
                          const Placement& X_WM) {
  FreeJoint result;
  result.name = attribute_of(joint, "name");
  result.kind = read_kind(xml, joint);
  const JointedLink* child = find_link(xml, joint, "child", links);
  const JointedLink* parent = find_link(xml, joint, "parent", links);
  if (!child) xml.fail(joint, "the child of a joint is 'world'. Exchange parent and child.");
  if (child == parent) xml.fail(joint, "a joint has one link at both ends. Correct its names.");
  result.child = child->body;
  if (parent) result.parent = parent->body;

  const Element* pose = xml.child(joint, "pose");
  const bool is_in_child =
      !pose || is_at_most_sdf(xml, joint, 6) || attribute_of(*pose, "relative_to").empty();
  const Placement own = pose ? read_placement(xml, *pose) : Placement();
  const Placement X_MJ = is_in_child ? child->X_ML * own : frames.find_pose(joint);
  const Placement X_MP = parent ? parent->X_ML : X_WM.inverse();
  const Placement X_CJ = child->X_ML.inverse() * X_MJ, X_PJ = X_MP.inverse() * X_MJ;
  result.anchor_C = X_CJ.position;
  result.anchor_P = X_PJ.position;
  result.q_PC_at_zero = (X_MP.inverse() * child->X_ML).rotation;
  const Vector3d axis_M = read_axis(xml, joint, "axis", X_MJ, frames);
  result.axis_P = X_MP.rotation.conjugate() * axis_M;
  result.axis_C =
      child->X_ML.rotation.conjugate() * (result.kind == FreeJointKind::universal
                                              ? read_axis(xml, joint, "axis2", X_MJ, frames)
                                              : axis_M);
  read_dynamics(xml, joint, result);
  refuse_dynamics(xml, joint, result);
  return result;
}

}  // namespace quadcore
