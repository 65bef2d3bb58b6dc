#pragma once

#include <cmath>

#include "quadcore/plugin/elementary.hpp"
#include "shared/sensing.hpp"

namespace quadcore::imu {

/// Errors of three orthogonal sensors of one kind, in the units of data sheets. Their memory
/// consists of the constant bias, the drifting bias and the random-walk bias.
class Triad {
 public:
  enum Memory { kBias, kDrift = kBias + 3, kWalk = kDrift + 3, kMemorySize = kWalk + 3 };

  Triad(const Parameters& p, const std::string& name)
      : noise_(p.number(name + "Noise")),
        bias_(p.number(name + "Bias")),
        drift_(p.number(name + "Drift")),
        drift_time_(p.number(name + "DriftTime")),
        walk_(p.number(name + "Walk")) {}

  /// Return the standard deviation of the noise on the mean over a period [s].
  double variance(double period) const { return noise_ * noise_ / period; }

  /// Initialise the errors; the drift starts in its stationary state.
  void begin(std::uint64_t seed, double& draws, Eigen::Ref<VectorXd> memory) const {
    memory.segment<3>(kBias) = bias_ * sensing::normal_vector(seed, draws);
    memory.segment<3>(kDrift) = drift_ * sensing::normal_vector(seed, draws);
    memory.segment<3>(kWalk).setZero();
  }

  /// Add the errors to a mean over a period.
  Vector3d apply(const Vector3d& truth, double period, std::uint64_t seed, double& draws,
                 Eigen::Ref<VectorXd> memory) const {
    const double decay = elementary::exp(-period / drift_time_);
    memory.segment<3>(kDrift) =
        decay * memory.segment<3>(kDrift) +
        drift_ * std::sqrt(1 - decay * decay) * sensing::normal_vector(seed, draws);
    memory.segment<3>(kWalk) += walk_ * std::sqrt(period) * sensing::normal_vector(seed, draws);
    return truth + memory.segment<3>(kBias) + memory.segment<3>(kDrift) + memory.segment<3>(kWalk) +
           noise_ / std::sqrt(period) * sensing::normal_vector(seed, draws);
  }

  /// Add rows to the plugin's table. `unit` is the unit without the factor of a density or a random
  /// walk.
  static void add_tags(std::vector<TagSpec>& tags, const std::string& name, const std::string& of,
                       const std::string& unit) {
    using T = TagSpec;
    tags.push_back(
        T::number(name + "Noise", unit + "/sqrt(Hz)", "0",
                  "density of the white noise of " + of + ", N; its Allan deviation is N/sqrt(tau)")
            .at_least(0)
            .from("IEEE 952, C.1.1"));
    tags.push_back(
        T::number(name + "Bias", unit, "0",
                  "standard deviation of the constant bias of " + of + " over all flights")
            .at_least(0));
    tags.push_back(
        T::number(
            name + "Drift", unit, "0",
            "standard deviation of the drifting bias of " + of +
                ", a Gauss-Markov process. Its Allan deviation has the maximum 0.618 times this "
                "value at 1.89 times the correlation time; for a bias instability B, use 1.075 B")
            .at_least(0)
            .from("IEEE 952, C.1.5"));
    tags.push_back(T::number(name + "DriftTime", "s", "1000", "correlation time of the drift")
                       .above(0)
                       .from("IEEE 952, C.1.5"));
    tags.push_back(
        T::number(name + "Walk", unit + "/sqrt(s)", "0",
                  "random walk of the bias of " + of + ", K; its Allan deviation is K sqrt(tau/3)")
            .at_least(0)
            .from("IEEE 952, C.1.4"));
  }

 private:
  double noise_, bias_, drift_, drift_time_, walk_;
};

}  // namespace quadcore::imu
