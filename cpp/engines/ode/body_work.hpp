#pragma once

#include "laws/articulated.hpp"

namespace quadcore {

using laws::Matrix3;
using laws::Spatial;
using laws::Vec3;

/// Intermediate results of a step for one body. Vectors are in W. O is the frame's centre of mass,
/// and other positions follow from the arms of the hinges. As in ODE's rows, gaps of hinges do not
/// lengthen the arms.
template <class T>
struct BodyWork {
  Matrix3<T> R_WB;
  Vec3<T> p_OBcm_W;
  Spatial<T> force;  ///< about the centre of mass; without gravity and `torque`
  T torque;          ///< torque of the hinge's joint on the body, opposite on the carrier
  laws::Symmetric3<T> I_Bcm_W;
  laws::SpatialInertia<T> carried;  ///< inertia that the body carries through hinges
  Spatial<T> borne;                 ///< force of the carried bodies, at O
  Spatial<T> acceleration;          ///< at O
  // Of the hinge:
  Vec3<T> axis_W, p_OA_W;
  Spatial<T> wanted;  ///< acceleration relative to the carrier that the rows require
  laws::Freedom<T> turn;
  Spatial<T> load_of_hinge;  ///< its load in the last step, at O, if requested
};

/// Compliant rows of a hinge: three of the anchor, two of the axis.
template <class T>
struct SoftRows {
  laws::Freedom<T> rows[5];
};

}  // namespace quadcore
