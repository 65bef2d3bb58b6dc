#pragma once

#include <cstddef>

#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/plugin/loads.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore {

/// Axes of a body's link, and a point of the body with its velocity, in world axes.
struct LinkMotion {
  Matrix3d R_WL;
  Vector3d p_W, v_W, w_W;
  Vector3d p_WS = {0, 0, 0};  ///< position of one of its shapes
  Vector3d velocity(const Vector3d& q_W) const { return v_W + w_W.cross(q_W - p_W); }
};

/// Return the motion of the frame (link 0) or of a rotor, of which the point is its centre of mass.
LinkMotion find_link_motion(const Kinematics& kinematics, std::size_t link);
/// Return the same with the position of one of the link's shapes.
LinkMotion find_shape_motion(const Model& model, const Kinematics& kinematics, std::size_t link,
                             const Collision& shape);

/// Add a force on a link and its torque about the point of its motion.
void add_link_load(const Kinematics& kinematics, std::size_t link, const Vector3d& f_W,
                   const Vector3d& tau_W, Loads& loads);

}  // namespace quadcore
