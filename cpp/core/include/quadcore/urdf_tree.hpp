#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "quadcore/gazebo_reference.hpp"
#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore QUADCORE_EXPORT {

/// A link as the URDF writes it.
struct UrdfLink {
  std::string name;                   ///< of the link
  std::optional<Inertial> inertial;   ///< nullopt where the URDF gives none
  std::vector<Collision> collisions;  ///< in the order of the file
  std::string where;                  ///< FILE:LINE
  BodyTags tags = {};                 ///< of the body that begins with this link
};

/// A joint as the URDF writes it: continuous, fixed or locked.
struct UrdfJoint {
  std::string name;    ///< of the joint
  bool fixed = false;  ///< whether the child is lumped into the parent
  /// Whether it is written as a revolute joint without any travel, which Gazebo keeps.
  bool locked = false;
  std::string parent;                 ///< name of a link
  std::string child;                  ///< name of a link
  Pose pose;                          ///< of the child link in the parent link at angle zero
  Vector3d axis = Vector3d::UnitX();  ///< unit, in the child link's axes
  double damping = 0;                 ///< N m s/rad
  double friction = 0;                ///< N m, dry
  bool implicit_damping = false;      ///< damping as a constraint instead of a torque
  std::string where;                  ///< FILE:LINE
};

/// The URDF before fixed links are lumped.
struct UrdfTree {
  std::string name;                         ///< of the robot
  std::string where;                        ///< FILE:LINE
  std::vector<UrdfLink> links;              ///< in the order of the file
  std::vector<UrdfJoint> joints;            ///< in the order of the file
  std::vector<PluginElement> plugins;       ///< in the order of the file
  std::vector<GazeboReference> references;  ///< in the order of the file
  std::vector<std::string> warnings;        ///< what was perhaps not meant, FILE:LINE first
  PassedOver passed_over;                   ///< what was not taken in
  std::string root;  ///< the link that no joint carries, as check_topology() finds it
};

/// Reads the elements of a URDF, each checked by itself.
/// \param ignore  see PassedOver.
UrdfTree read_urdf_tree(const Document& document, const std::vector<std::string>& ignore);

/// Checks how links and joints hang together, and finds the root.
void check_topology(UrdfTree& tree);

/// \name The order of Gazebo, which walks a model depth first and the joints of a link by name
/// @{

/// The joints below each link, by name.
using JointsBelow = std::map<std::string, std::map<std::string, const UrdfJoint*>>;
/// All joints of a tree, into which they point.
JointsBelow joints_below(const UrdfTree& tree);

/// A link that Gazebo has as its own: the root, or one on a joint that turns or is locked.
struct SdfLink {
  /// A URDF link that it is made of.
  struct Part {
    std::string link;        ///< its name
    const UrdfJoint* joint;  ///< the fixed joint that carries it; null for the first part
    std::size_t parent;      ///< index of the part that it is fixed to
  };
  std::vector<Part> parts;           ///< its own link first, parents before what they carry
  const UrdfJoint* joint = nullptr;  ///< that carries it; null for the root
};
/// The root first, each after the one that carries it. They point into the tree.
std::vector<SdfLink> sdf_links(const UrdfTree& tree);
/// @}

}  // namespace quadcore
