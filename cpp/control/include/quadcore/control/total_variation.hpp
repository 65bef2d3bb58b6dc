#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "quadcore/plugin/export.hpp"

namespace quadcore::control {

/// Sums the changes of the magnitudes of some numbers, their total variation.
class TotalVariation {
 public:
  /// \param count  how many numbers
  explicit TotalVariation(std::size_t count) : last_(count), sums_(count) {}

  /// Add the next values of the numbers.
  void add(const double* values) {
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const double value = std::abs(values[i]);
      if (!is_first_) sums_[i] += std::abs(value - last_[i]);
      last_[i] = value;
    }
    is_first_ = false;
  }
  /// Return the sum of each number.
  const std::vector<double>& sums() const { return sums_; }

 private:
  std::vector<double> last_, sums_;
  bool is_first_ = true;
};

}  // namespace quadcore::control
