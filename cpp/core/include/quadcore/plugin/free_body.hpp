#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/obstacle.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore QUADCORE_EXPORT {

/// A link of a world's model that is not static.
struct FreeBody {
  std::string model;                       ///< name of its model: MODEL, or MODEL::NESTED
  std::string name;                        ///< name of the link
  Inertial inertial;                       ///< mass, centre of mass and inertia
  Vector3d position_W = Vector3d::Zero();  ///< of the link at the start [m]
  Quaterniond orientation_W = Quaterniond::Identity();  ///< of the link at the start
  Vector3d linear_velocity_W = Vector3d::Zero();        ///< of the link at the start [m/s]
  Vector3d angular_velocity_W = Vector3d::Zero();       ///< at the start [rad/s]
  bool gravity = true;                                  ///< whether gravity acts on it
  bool may_sleep = true;         ///< whether it stops after a second of rest in contact
  bool collides_own = false;     ///< whether it touches other links of its model
  double linear_decay = 0;       ///< fraction of the velocity that it loses in each step
  double angular_decay = 0;      ///< fraction of the angular velocity that it loses in each step
  std::vector<Obstacle> shapes;  ///< where they are at the start
  std::string where;             ///< FILE:LINE
};

/// Kind of a joint between free bodies; see FreeJoint for its axes.
enum class FreeJointKind { fixed, revolute, prismatic, universal, ball };

/// A joint between two free bodies, or a free body and the world. At position zero the anchors
/// coincide.
struct FreeJoint {
  /// Stands for the world as the parent.
  static constexpr std::size_t world = static_cast<std::size_t>(-1);

  std::string name;                                    ///< MODEL::JOINT
  FreeJointKind kind = FreeJointKind::revolute;        ///< defines the meaning of the axes
  std::size_t child = 0;                               ///< index among World::free_bodies
  std::size_t parent = world;                          ///< likewise, or `world`
  Vector3d anchor_C = Vector3d::Zero();                ///< in the axes of the child link [m]
  Vector3d anchor_P = Vector3d::Zero();                ///< in those of the parent [m]
  Quaterniond q_PC_at_zero = Quaterniond::Identity();  ///< orientation of the child at zero
  /// Axis of a revolute or prismatic joint, and second axis of a universal one, in the child; unit.
  Vector3d axis_C = Vector3d::UnitZ();
  Vector3d axis_P = Vector3d::UnitZ();  ///< the same in the parent, but the first axis; unit
  double lower = -1e16;                 ///< lower limit of the position [rad, m]
  double upper = 1e16;                  ///< upper limit of the position [rad, m]
  double damping = 0;                   ///< N m s/rad, N s/m
  double friction = 0;                  ///< N m, N
  double stiffness = 0;                 ///< of a spring [N m/rad, N/m]
  double rest_position = 0;             ///< of that spring [rad, m]
};

/// Motion of a free body.
struct FreeBodyState {
  std::string name;             ///< MODEL::LINK
  Vector3d position_W;          ///< of the link's origin [m]
  Quaterniond orientation_W;    ///< of the link's axes
  Vector3d linear_velocity_W;   ///< of the link's origin [m/s]
  Vector3d angular_velocity_W;  ///< rad/s
};

}  // namespace quadcore
