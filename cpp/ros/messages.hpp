#pragma once

#include <geometry_msgs/Quaternion.h>
#include <ros/time.h>

/// \file
/// From numbers to parts of messages.

namespace quadcore::node {

constexpr const char* world_frame = "world";

inline ros::Time to_ros(double time) { return ros::Time().fromSec(time); }

template <class Vector>
void set_vector(Vector& vector, const double* values) {
  vector.x = values[0];
  vector.y = values[1];
  vector.z = values[2];
}

inline void set_quaternion(geometry_msgs::Quaternion& quaternion, const double* xyzw) {
  set_vector(quaternion, xyzw);
  quaternion.w = xyzw[3];
}

}  // namespace quadcore::node
