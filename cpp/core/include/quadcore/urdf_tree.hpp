#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "quadcore/gazebo_reference.hpp"
#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore QUADCORE_EXPORT {

/// A link as written in the URDF.
struct UrdfLink {
  std::string name;                   ///< name of the link
  std::optional<Inertial> inertial;   ///< nullopt if the URDF gives none
  std::vector<Collision> collisions;  ///< in the order of the file
  std::string where;                  ///< FILE:LINE
  BodyTags tags = {};                 ///< settings of the body with this link as its root
};

/// A joint as written in the URDF: continuous, fixed or locked.
struct UrdfJoint {
  std::string name;    ///< name of the joint
  bool fixed = false;  ///< whether the child is lumped into the parent
  /// Whether it is a revolute joint without travel, which Gazebo keeps.
  bool locked = false;
  std::string parent;                 ///< name of a link
  std::string child;                  ///< name of a link
  Pose pose;                          ///< pose of the child link in the parent link at angle zero
  Vector3d axis = Vector3d::UnitX();  ///< unit vector in the child link's axes
  double damping = 0;                 ///< N m s/rad
  double friction = 0;                ///< N m, dry
  bool implicit_damping = false;      ///< damping as a constraint instead of a torque
  std::string where;                  ///< FILE:LINE
};

/// The URDF before fixed links are lumped.
struct UrdfTree {
  std::string name;                         ///< name of the robot
  std::string where;                        ///< FILE:LINE
  std::vector<UrdfLink> links;              ///< in the order of the file
  std::vector<UrdfJoint> joints;            ///< in the order of the file
  std::vector<PluginElement> plugins;       ///< in the order of the file
  std::vector<GazeboReference> references;  ///< in the order of the file
  std::vector<std::string> warnings;        ///< warnings, starting with FILE:LINE
  IgnoredElements ignored_elements;         ///< elements that were not used
  std::string root;  ///< the link without a parent, found by check_topology()
};

/// Read the elements of a URDF and check each individually.
/// \param ignore  see IgnoredElements.
UrdfTree read_urdf_tree(const Document& document, const std::vector<std::string>& ignore);

/// Check the connections of links and joints, and find the root.
void check_topology(UrdfTree& tree);

/// \name Gazebo's order: depth first, with the joints of a link by name
/// @{

/// The child joints of each link, by name.
using JointsBelow = std::map<std::string, std::map<std::string, const UrdfJoint*>>;
/// Return the child joints of all links; they point into the tree.
JointsBelow joints_below(const UrdfTree& tree);

/// A separate link in Gazebo: the root, or the child of a turning or locked joint.
struct SdfLink {
  /// A URDF link that is part of it.
  struct Part {
    std::string link;        ///< name of the URDF link
    const UrdfJoint* joint;  ///< fixed joint to its parent; null for the first part
    std::size_t parent;      ///< index of the part that is its parent
  };
  std::vector<Part> parts;           ///< its own link first, parents before children
  const UrdfJoint* joint = nullptr;  ///< joint to its parent; null for the root
};
/// Return all links, the root first and parents before children. They point into the tree.
std::vector<SdfLink> sdf_links(const UrdfTree& tree);
/// @}

}  // namespace quadcore
