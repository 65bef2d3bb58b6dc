#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace quadcore {

/// Sums the changes of the magnitudes of some numbers, their total variation.
class TotalVariation {
 public:
  /// \param count  how many numbers
  explicit TotalVariation(std::size_t count) : last_(count), sums_(count) {}

  /// Add the next values of the numbers.
  void add(const double* values) {
    add_each([values](std::size_t i) { return values[i]; });
  }
  /// Add the next values; value(i) returns that of number i.
  template <class Value>
  void add_each(const Value& value) {
    double *const last = last_.data(), *const sums = sums_.data();
    const std::size_t count = sums_.size();
    for (std::size_t i = 0; i < count; ++i) {
      const double size = std::abs(value(i));
      if (!is_first_) sums[i] += std::abs(size - last[i]);
      last[i] = size;
    }
    is_first_ = false;
  }
  /// Return the sum of each number.
  const std::vector<double>& sums() const { return sums_; }

 private:
  std::vector<double> last_, sums_;
  bool is_first_ = true;
};

}  // namespace quadcore
