#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "quadcore/plugin.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/random.hpp"

namespace quadcore::sensing {

/// Errors of n numbers that are measured together: white noise, and a drifting error, which is a
/// Gauss-Markov process in its stationary state from the start.
template <int n>
class NoiseAndDrift {
 public:
  using Numbers = Eigen::Matrix<double, n, 1>;
  /// Whether it is turned on, the time, the number of random numbers drawn, and the drifting error.
  enum Memory { kOn, kTime, kDraws, kDrift, kMemorySize = kDrift + n };

  /// \param noise, drift  standard deviations
  /// \param drift_time    correlation time [s]
  NoiseAndDrift(const Numbers& noise, const Numbers& drift, double drift_time)
      : noise_(noise), drift_(drift), drift_time_(drift_time) {}
  /// Create from the tags of add_tags(), which apply to each number.
  explicit NoiseAndDrift(const Parameters& p)
      : NoiseAndDrift(Numbers::Constant(p.number("noise")), Numbers::Constant(p.number("drift")),
                      p.number("driftTime")) {}

  Numbers variance() const { return noise_.cwiseAbs2() + drift_.cwiseAbs2(); }

  /// Return the error of a measurement.
  Numbers next(const Sample& sample, Eigen::Ref<VectorXd> memory) const {
    auto drift = memory.template segment<n>(kDrift);
    if (memory[kOn] == 0) {
      memory[kOn] = 1;
      drift = drift_.cwiseProduct(draw(sample, memory));
    } else {
      const double since = sample.jumped ? 0 : sample.time - memory[kTime];
      const double decay = elementary::exp(-since / drift_time_);
      drift =
          decay * drift + std::sqrt(1 - decay * decay) * drift_.cwiseProduct(draw(sample, memory));
    }
    memory[kTime] = sample.time;
    return drift + noise_.cwiseProduct(draw(sample, memory));
  }

  /// Draw further standard normal numbers from the same stream.
  static Numbers draw(const Sample& sample, Eigen::Ref<VectorXd> memory) {
    Numbers numbers;
    for (int i = 0; i < n; ++i) numbers[i] = random_normal(sample.seed, memory[kDraws]);
    return numbers;
  }

  static TagSpec drift_time_tag() {
    return TagSpec::number("driftTime", "s", "60", "correlation time of the drift").above(0);
  }
  /// \param of  the measured quantity
  static void add_tags(std::vector<TagSpec>& tags, const std::string& unit, const std::string& of) {
    tags.push_back(
        TagSpec::number("noise", unit, "0", "standard deviation of the white noise of " + of)
            .at_least(0));
    tags.push_back(TagSpec::number("drift", unit, "0",
                                   "standard deviation of a drifting error of " + of +
                                       ", a Gauss-Markov process")
                       .at_least(0));
    tags.push_back(drift_time_tag());
  }

 private:
  Numbers noise_, drift_;
  double drift_time_;  ///< s
};

}  // namespace quadcore::sensing
