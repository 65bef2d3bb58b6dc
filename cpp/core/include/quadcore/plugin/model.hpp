#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "quadcore/plugin/document.hpp"
#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/passed_over.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Mass [kg] and inertia [kg m^2] of a link. The inertia is taken about the centre of mass along
/// the axes of `pose`, which places the centre of mass in the link's frame.
struct Inertial {
  double mass = 0;  ///< kg
  Pose pose;        ///< of the centre of mass, and of the axes of `inertia`, in the link
  Matrix3d inertia = Matrix3d::Zero();  ///< kg m^2

  /// The inertia about the centre of mass along the link's own axes [kg m^2].
  Matrix3d inertia_in_link_axes() const;
  /// Principal moments [kg m^2], ascending.
  Vector3d principal_moments() const;
  /// Whether a body can turn with it: all principal moments > 0, and not by rounding only.
  bool is_positive() const;
};

/// What a collision shape is; for its measures see Collision.
enum class ShapeKind { box, cylinder, sphere, mesh };

/// How a shape feels the ground; the defaults are Gazebo 11's.
struct Surface {
  /// Coefficient of friction along fdir1.
  double mu1 = 1, mu2 = 1;            ///< coefficient of friction across it
  Vector3d fdir1 = Vector3d::Zero();  ///< in the shape's axes, of any length; zero: the world's -y
  double kp = 1e12;                   ///< N/m
  double kd = 1;                      ///< N s/m
  double min_depth = 0;               ///< m of penetration that are not corrected
  double max_vel = 0.01;              ///< m/s of velocity that a correction may leave
  int max_contacts = 10;              ///< points
};

/// A collision shape. `size`: box x, y, z; cylinder radius, length; sphere radius [m]. A mesh has
/// none: no engine collides one, and a world with a ground plane refuses it.
struct Collision {
  ShapeKind kind;         ///< what `size` means
  Vector3d size;          ///< m
  Pose pose;              ///< of the shape in the link
  std::string where;      ///< FILE:LINE
  std::string name = {};  ///< as the URDF writes it; "" without
  Surface surface = {};   ///< how it feels the ground
};

/// What a `<gazebo reference>` says of how a whole body moves.
struct BodyTags {
  bool gravity = true;        ///< whether it has weight
  double damping_factor = 0;  ///< part of its velocity that a body loses in each step
  std::string where;          ///< FILE:LINE of the tag that is not at its default
};

/// A moving body: a URDF link together with every link fixed to it.
struct Link {
  std::string name;                   ///< of the link that the others are fixed to
  Inertial inertial;                  ///< of all of them
  std::vector<Collision> collisions;  ///< of all of them
  std::string where;                  ///< FILE:LINE
  BodyTags tags = {};                 ///< what else is said of it
};

/// A continuous joint. Joint i carries link i + 1; link 0 is the frame, the root of the tree.
struct Joint {
  std::string name;                   ///< as the URDF writes it
  std::size_t parent = 0;             ///< index of the parent link
  Pose pose;                          ///< of the child link in the parent link at angle zero
  Vector3d axis = Vector3d::UnitX();  ///< unit, in the child link's axes
  double damping = 0;                 ///< N m s/rad
  double friction = 0;                ///< N m, dry
  bool implicit_damping = false;      ///< damping as a constraint instead of a torque
  std::string where;                  ///< FILE:LINE
};

/// One parameter of a plugin as the URDF writes it.
struct PluginTag {
  std::string name;   ///< of the element
  std::string text;   ///< as written
  std::string where;  ///< FILE:LINE
};

/// A plugin tag: which module to load, under which name, with which parameters.
struct PluginElement {
  std::string name;             ///< as the URDF writes it
  std::string filename;         ///< of the module
  std::vector<PluginTag> tags;  ///< in the order of the file
  std::string where;            ///< FILE:LINE
  std::string fault = {};       ///< FILE:LINE: what is wrong with the tags, told if it is loaded
};

struct UrdfTree;

/// A vehicle: bodies, joints, plugins. Bodies are indexed links[0] = frame, links[i+1] = child of
/// joints[i]; parents come before their children.
struct Model {
  std::string name;                    ///< of the robot
  std::vector<Link> links;             ///< bodies
  std::vector<Joint> joints;           ///< continuous ones
  std::vector<PluginElement> plugins;  ///< in the order of the file
  std::vector<std::string> warnings;   ///< what was perhaps not meant, FILE:LINE first
  PassedOver passed_over;              ///< what its reader did not take in
  /// Every link name of the URDF, lumped ones included, and the body that carries it.
  std::map<std::string, std::size_t> body_of_link;
  /// Every link name of the URDF, and where the link sits in that body.
  std::map<std::string, Pose> pose_of_link;
  /// What it was read from, for an engine that lumps in another way.
  std::shared_ptr<const UrdfTree> urdf;
  /// The same as text; null unless read_model() made it.
  std::shared_ptr<const Source> source;

  /// Names of the joints, in the order of `joints`.
  std::vector<std::string> joint_names() const;
};

/// Mass [kg], centre of mass from F's origin in F's axes [m] and inertia about it in F's axes
/// [kg m^2] of the whole vehicle, all joints at angle zero.
struct MassProperties {
  double mass = 0;                            ///< kg
  Vector3d p_FCcm = Vector3d::Zero();         ///< m
  Matrix3d inertia_Ccm_F = Matrix3d::Zero();  ///< kg m^2
};
/// Sums up the bodies of a model, all joints at angle zero.
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
