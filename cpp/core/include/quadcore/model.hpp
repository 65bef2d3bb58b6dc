#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "quadcore/document.hpp"
#include "quadcore/passed_over.hpp"
#include "quadcore/spatial.hpp"

namespace quadcore {

/// Mass [kg] and inertia [kg m^2] of a link. The inertia is taken about the centre of mass along
/// the axes of `pose`, which places the centre of mass in the link's frame.
struct Inertial {
  double mass = 0;
  Pose pose;
  Matrix3d inertia = Matrix3d::Zero();

  /// The inertia about the centre of mass along the link's own axes [kg m^2].
  Matrix3d inertia_in_link_axes() const;
  /// Principal moments [kg m^2], ascending.
  Vector3d principal_moments() const;
  /// Whether a body can turn with it: all principal moments > 0, and not by rounding only.
  bool is_positive() const;
};

enum class ShapeKind { box, cylinder, sphere, mesh };

/// A collision shape. `size`: box x, y, z; cylinder radius, length; sphere radius [m]. A mesh has
/// none: no engine collides one, and a world with a ground plane refuses it.
struct Collision {
  ShapeKind kind;
  Vector3d size;
  Pose pose;
  std::string where;
};

/// A moving body: a URDF link together with every link fixed to it.
struct Link {
  std::string name;
  Inertial inertial;
  std::vector<Collision> collisions;
  std::string where;
};

/// A continuous joint. Joint i carries link i + 1; link 0 is the frame, the root of the tree.
struct Joint {
  std::string name;
  std::size_t parent = 0;             ///< index of the parent link
  Pose pose;                          ///< of the child link in the parent link at angle zero
  Vector3d axis = Vector3d::UnitX();  ///< unit, in the child link's axes
  Vector3d axis_as_written = axis;    ///< of any length; Gazebo rounds this one
  double damping = 0;                 ///< N m s/rad
  std::string where;
};

/// One parameter of a plugin as the URDF writes it.
struct PluginTag {
  std::string name;
  std::string text;
  std::string where;
};

/// A plugin tag: which module to load, under which name, with which parameters.
struct PluginElement {
  std::string name;
  std::string filename;
  std::vector<PluginTag> tags;
  std::string where;
  std::string fault = {};  ///< FILE:LINE: what is wrong with the tags, told if it is loaded
};

/// A vehicle: bodies, joints, plugins. Bodies are indexed links[0] = frame, links[i+1] = child of
/// joints[i]; parents come before their children.
struct Model {
  std::string name;
  std::vector<Link> links;
  std::vector<Joint> joints;
  std::vector<PluginElement> plugins;
  std::vector<std::string> warnings;
  PassedOver passed_over;
  /// Every link name of the URDF, lumped ones included, and the body that carries it.
  std::map<std::string, std::size_t> body_of_link;
  /// Indices of the links in the order of Gazebo's SDF: depth first, joints by name.
  std::vector<std::size_t> sdf_order;

  std::vector<std::string> joint_names() const;
};

/// Mass [kg], centre of mass from F's origin in F's axes [m] and inertia about it in F's axes
/// [kg m^2] of the whole vehicle, all joints at angle zero.
struct MassProperties {
  double mass = 0;
  Vector3d p_FCcm = Vector3d::Zero();
  Matrix3d inertia_Ccm_F = Matrix3d::Zero();
};
MassProperties mass_properties(const Model& model);

/// Poses of every link in the frame link, all joints at angle zero.
std::vector<Eigen::Isometry3d> link_poses(const Model& model);

/// Moment of inertia of the link that joint i carries about the joint's axis [kg m^2].
double moment_about_joint(const Model& model, std::size_t i);

/// Reads a URDF as Gazebo does: links on fixed joints are lumped into the body that carries them.
/// \param ignore  names of what is to be left out, see PassedOver.
/// Throws InputError with FILE:LINE on anything felt that Gazebo or the engines would not honour,
/// and on anything foreign that is not ignored.
Model read_model(const Document& document, const std::vector<std::string>& ignore = {});

}  // namespace quadcore
