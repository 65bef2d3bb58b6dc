#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "quadcore/plugin/messages.hpp"
#include "quadcore/plugin/random.hpp"

namespace quadcore {

/// Errors of a measured vector: white noise, a random-walk bias and quantisation.
struct VectorErrors {
  double noise;       ///< standard deviation
  double walk;        ///< standard deviation of the bias after 1 s
  double resolution;  ///< quantisation step; 0: none

  /// Return whether measurements are exact.
  bool is_none() const { return noise == 0 && walk == 0 && resolution == 0; }
  /// Return the variance of each component without the random walk, which no reader can know.
  double variance() const { return noise * noise + resolution * resolution / 12; }
  /// Return by how much a measurement advances the count of random numbers.
  double draws() const { return 6 * ((noise != 0) + (walk != 0)); }

  /// Return a measurement.
  /// \param since  time since the last measurement [s]
  /// \param draws  count of random numbers, which advances by draws()
  /// \param bias   three numbers, which the random walk changes
  Vector3d apply(const Vector3d& truth, double since, std::uint64_t seed, double& draws,
                 double* bias) const {
    const auto normal = [&] {
      Vector3d v;
      for (int i = 0; i < 3; ++i) v[i] = random_normal(seed, draws);
      return v;
    };
    Vector3d v = truth;
    if (noise != 0) v += noise * normal();
    if (walk != 0) {
      Eigen::Map<Vector3d> walked(bias);
      walked += walk * std::sqrt(since) * normal();
      v += walked;
    }
    if (resolution != 0) {
      for (int i = 0; i < 3; ++i) v[i] = resolution * std::floor(v[i] / resolution + 0.5);
    }
    return v;
  }
};

/// Errors of odometry. Those of the orientation are small rotations about the body axes.
struct OdometryErrors {
  static constexpr std::size_t biases = 12;  ///< number of biases

  VectorErrors position;          ///< m
  VectorErrors orientation;       ///< rad
  VectorErrors linear_velocity;   ///< m/s
  VectorErrors angular_velocity;  ///< rad/s

  /// Return whether measurements are exact.
  bool is_none() const {
    return position.is_none() && orientation.is_none() && linear_velocity.is_none() &&
           angular_velocity.is_none();
  }
  /// Return whether a measurement depends on the previous ones only by the count of random numbers.
  bool are_independent() const {
    return position.walk == 0 && orientation.walk == 0 && linear_velocity.walk == 0 &&
           angular_velocity.walk == 0;
  }
  /// Return by how much a measurement advances the count of random numbers.
  double draws() const {
    return position.draws() + orientation.draws() + linear_velocity.draws() +
           angular_velocity.draws();
  }

  /// Turn true odometry into a measurement; the arguments are like those of VectorErrors::apply().
  void apply(messages::Odometry& odometry, double since, std::uint64_t seed, double& draws,
             double* bias) const {
    const auto measured = [&](const VectorErrors& errors, const Vector3d& truth, int quantity) {
      return errors.apply(truth, since, seed, draws, bias + 3 * quantity);
    };
    odometry.position = measured(position, odometry.position, 0);
    const Vector3d turn = measured(orientation, Vector3d::Zero(), 1);
    const double angle = turn.norm();
    if (angle > 0)
      odometry.orientation = odometry.orientation * quaternion_about(turn / angle, angle);
    odometry.linear_velocity = measured(linear_velocity, odometry.linear_velocity, 2);
    odometry.angular_velocity = measured(angular_velocity, odometry.angular_velocity, 3);
  }
};

/// A sensor of odometry as quadcore's own plugin describes it, so that a batch can measure by
/// itself.
struct OdometrySensor {
  std::size_t topic;      ///< index of its topic
  OdometryErrors errors;  ///< errors of its measurements
  /// Whether it measures at the end of every step, publishes at once in world axes, and has no
  /// other memory than the count of random numbers.
  bool is_simple;
  std::optional<std::uint64_t> seed;  ///< its own seed, instead of the simulation's
};

}  // namespace quadcore
