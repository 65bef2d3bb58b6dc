#pragma once

#include "laws/articulated.hpp"

namespace quadcore {

using laws::Matrix3;
using laws::Spatial;
using laws::Vec3;

/// What a step finds out of a body, on the way. Vectors are in W. O is where the frame's centre of
/// mass is, and other places follow from the arms of the hinges: as in ODE's rows, no gap of a
/// hinge lengthens them.
template <class T>
struct BodyWork {
  Matrix3<T> R_WB;
  Vec3<T> p_OBcm_W;
  Spatial<T> force;  ///< about the centre of mass; without gravity and the next
  T torque;          ///< of the hinge's joint on the body, and against it on the carrier
  laws::Symmetric3<T> I_Bcm_W;
  laws::SpatialInertia<T> carried;  ///< by hinges, as the body feels it
  Spatial<T> borne;                 ///< force by what it carries, at O
  Spatial<T> acceleration;          ///< at O
  // Of the hinge:
  Vec3<T> axis_W, p_OA_W;
  Spatial<T> wanted;  ///< acceleration beyond the carrier's that the rows ask for
  laws::Freedom<T> turn;
  Spatial<T> load_of_hinge;  ///< what it has exerted in the last step, at O, if that was asked for
};

/// The rows of a hinge that give way: three of the anchor, two of the axis.
template <class T>
struct SoftRows {
  laws::Freedom<T> rows[5];
};

}  // namespace quadcore
