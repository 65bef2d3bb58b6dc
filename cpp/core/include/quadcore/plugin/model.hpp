#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "quadcore/plugin/document.hpp"
#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/ignored_elements.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Mass [kg] and inertia [kg m^2] of a link. The inertia is about the centre of mass along the axes
/// of `pose`, which locates the centre of mass in the link.
struct Inertial {
  double mass = 0;  ///< mass [kg]
  Pose pose;        ///< pose of the centre of mass and the axes of `inertia` in the link
  Matrix3d inertia = Matrix3d::Zero();  ///< kg m^2

  /// Return the inertia about the centre of mass along the link's axes [kg m^2].
  Matrix3d inertia_in_link_axes() const;
  /// Return the principal moments in ascending order [kg m^2].
  Vector3d principal_moments() const;
  /// Return whether all principal moments are positive beyond rounding errors.
  bool is_positive() const;
};

/// Kind of a collision shape; see Collision and Obstacle for its dimensions. Only obstacles are
/// planes.
enum class ShapeKind { box, cylinder, sphere, mesh, plane };

/// Contact parameters of a shape; the defaults are Gazebo 11's.
struct Surface {
  /// Coefficient of friction along fdir1.
  double mu1 = 1, mu2 = 1;  ///< coefficient of friction across it
  Vector3d fdir1 =
      Vector3d::Zero();  ///< direction of mu1 in the shape's axes, any length; zero: the world's -y
  double kp = 1e12;      ///< N/m
  double kd = 1;         ///< N s/m
  double min_depth = 0;  ///< penetration that is not corrected [m]
  double max_vel = 0.01;  ///< maximum velocity that remains after a correction [m/s]
  int max_contacts = 10;  ///< points
};

/// A collision shape. `size`: box x, y, z; cylinder radius, length; sphere radius [m]. A mesh has
/// no size: no engine supports its contact, and it is an error in a world with a ground plane.
struct Collision {
  ShapeKind kind;         ///< defines the meaning of `size`
  Vector3d size;          ///< m
  Pose pose;              ///< pose of the shape in the link
  std::string where;      ///< FILE:LINE
  std::string name = {};  ///< name in the URDF, or ""
  Surface surface = {};   ///< contact parameters
};

/// Return the distance of a box's, cylinder's or sphere's farthest point from its centre [m]; 0 for
/// any other shape.
double outer_radius(ShapeKind kind, const Vector3d& size);

/// Settings of a `<gazebo reference>` that affect the motion of a whole body.
struct BodyTags {
  bool gravity = true;        ///< whether gravity acts on the body
  double damping_factor = 0;  ///< fraction of the velocity that the body loses in each step
  std::string where;          ///< FILE:LINE of the tag with a value other than the default
};

/// A moving body: a URDF link together with every link fixed to it.
struct Link {
  std::string name;                   ///< name of the link that the others are fixed to
  Inertial inertial;                  ///< total mass and inertia
  std::vector<Collision> collisions;  ///< shapes of all links
  std::string where;                  ///< FILE:LINE
  BodyTags tags = {};                 ///< settings of `<gazebo reference>`
};

/// A continuous joint. Joint i carries link i + 1; link 0 is the frame, the root of the tree.
struct Joint {
  std::string name;                   ///< name in the URDF
  std::size_t parent = 0;             ///< index of the parent link
  Pose pose;                          ///< pose of the child link in the parent link at angle zero
  Vector3d axis = Vector3d::UnitX();  ///< unit vector in the child link's axes
  double damping = 0;                 ///< N m s/rad
  double friction = 0;                ///< N m, dry
  bool implicit_damping = false;      ///< damping as a constraint instead of a torque
  std::string where;                  ///< FILE:LINE
};

/// One parameter of a plugin as written in the URDF.
struct PluginTag {
  std::string name;   ///< name of the element
  std::string text;   ///< text as written
  std::string where;  ///< FILE:LINE
};

/// A plugin tag with the module to load, its name and its parameters.
struct PluginElement {
  std::string name;             ///< name in the URDF
  std::string filename;         ///< file name of the module
  std::vector<PluginTag> tags;  ///< in the order of the file
  std::string where;            ///< FILE:LINE
  std::string fault = {};       ///< error in the tags, raised only if the plugin is loaded
};

struct UrdfTree;

/// A vehicle with bodies, joints and plugins. links[0] is the frame and links[i+1] the child of
/// joints[i]; parents come before their children.
struct Model {
  std::string name;                    ///< name of the robot
  std::vector<Link> links;             ///< bodies
  std::vector<Joint> joints;           ///< continuous joints
  std::vector<PluginElement> plugins;  ///< in the order of the file
  std::vector<std::string>
      warnings;  ///< warnings about valid but suspicious input, starting with FILE:LINE
  IgnoredElements ignored_elements;  ///< elements that the reader did not use
  /// Body index of every link of the URDF, including lumped links.
  std::map<std::string, std::size_t> body_of_link;
  /// Pose of every link of the URDF in its body.
  std::map<std::string, Pose> pose_of_link;
  /// Source of the model, for an engine that lumps links differently.
  std::shared_ptr<const UrdfTree> urdf;
  /// Source as text; null unless read_model() created the model.
  std::shared_ptr<const Source> source;

  /// Return the names of the joints, in the order of `joints`.
  std::vector<std::string> joint_names() const;
};

/// Mass, centre of mass and inertia of the whole vehicle with all joints at angle zero.
struct MassProperties {
  double mass = 0;                            ///< total mass [kg]
  Vector3d p_FCcm = Vector3d::Zero();         ///< centre of mass from F's origin, F axes [m]
  Matrix3d inertia_Ccm_F = Matrix3d::Zero();  ///< about the centre of mass, F axes [kg m^2]
};
/// Return the mass properties of a model with all joints at angle zero.
MassProperties mass_properties(const Model& model);

/// Return the pose of every link in the frame link with all joints at angle zero.
std::vector<Eigen::Isometry3d> link_poses(const Model& model);

/// Return the moment of inertia of joint i's child link about the joint's axis [kg m^2].
double moment_about_joint(const Model& model, std::size_t i);

/// Read a URDF as Gazebo does: links on fixed joints are lumped with their parent body.
/// \param ignore  names of elements to ignore, see IgnoredElements.
/// Throws InputError with FILE:LINE for elements that affect the motion but are not modelled, and
/// for unknown elements that are not ignored.
Model read_model(const Document& document, const std::vector<std::string>& ignore = {});

}  // namespace quadcore
