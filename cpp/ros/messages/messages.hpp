#pragma once

#include <geometry_msgs/Quaternion.h>
#include <ros/time.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string>

#include "quadcore/plugin/spatial.hpp"
#include "quadcore/text.hpp"

/// \file
/// Conversions between numbers and parts of messages.

namespace quadcore::node {

/// Queue size of a topic, for slow subscribers.
constexpr std::uint32_t queue_size = 1000;

/// Minimum variance, a deviation of 1e-6. Some filters interpret zero as "unknown", others cannot
/// invert it.
constexpr double min_variance = 1e-12;

/// Sets a diagonal covariance, with equal numbers for each three.
template <class Matrix>
void set_covariance(Matrix& matrix, std::initializer_list<double> variances) {
  const std::size_t side = 3 * variances.size();
  for (std::size_t i = 0; i < side; ++i) {
    matrix[(side + 1) * i] = std::max(variances.begin()[i / 3], min_variance);
  }
}

inline ros::Time to_ros(double time) { return ros::Time().fromSec(time); }

template <class Vector>
void set_vector(Vector& vector, const double* values) {
  vector.x = values[0];
  vector.y = values[1];
  vector.z = values[2];
}

/// Whether a quaternion has length 1.
inline bool is_unit(const Quaterniond& q) {
  constexpr double roundness = 1e-3;  // tolerance of the length
  return std::abs(q.norm() - 1) <= roundness;
}

/// Returns the numbers of a vector as the text of a plugin's tag.
inline std::string format_vector(const Vector3d& vector) {
  std::string text;
  for (const double* number = vector.data(); number != vector.data() + 3; ++number) {
    if (!text.empty()) text += ' ';
    append_shortest(*number, text);
  }
  return text;
}

template <class Vector>
Vector3d vector_of(const Vector& vector) {
  return {vector.x, vector.y, vector.z};
}

inline void set_quaternion(geometry_msgs::Quaternion& quaternion, const double* xyzw) {
  set_vector(quaternion, xyzw);
  quaternion.w = xyzw[3];
}

}  // namespace quadcore::node
