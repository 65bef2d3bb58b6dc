#pragma once

#include <cmath>

#include "shared/sensing.hpp"

namespace quadcore::odometry {

/// Errors of a measured vector: white noise, a random-walk bias and quantisation. The memory is the
/// bias.
class Imperfection {
 public:
  Imperfection(const Parameters& p, const std::string& quantity, bool has_resolution)
      : noise_(p.number(quantity + "Noise")),
        walk_(p.number(quantity + "Walk")),
        step_(has_resolution ? p.number(quantity + "Resolution") : 0) {}

  bool is_none() const { return noise_ == 0 && walk_ == 0 && step_ == 0; }

  /// Return the variance of each component without the random walk, which no reader can know.
  double variance() const { return noise_ * noise_ + step_ * step_ / 12; }

  Vector3d apply(const Vector3d& truth, double since, std::uint64_t seed, double& draws,
                 Eigen::Ref<Vector3d> bias) const {
    Vector3d v = truth;
    if (noise_ != 0) v += noise_ * sensing::normal_vector(seed, draws);
    if (walk_ != 0) {
      bias += walk_ * std::sqrt(since) * sensing::normal_vector(seed, draws);
      v += bias;
    }
    if (step_ != 0) {
      for (int i = 0; i < 3; ++i) v[i] = step_ * std::floor(v[i] / step_ + 0.5);
    }
    return v;
  }

 private:
  double noise_;  ///< standard deviation
  double walk_;   ///< standard deviation after 1 s
  double step_;
};

}  // namespace quadcore::odometry
