#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "quadcore/plugin/rotor_rows.hpp"

namespace quadcore {

/// Sums the changes of the magnitudes of some numbers, their total variation.
class TotalVariation {
 public:
  /// \param count  how many numbers
  explicit TotalVariation(std::size_t count) : last_(count), sums_(count) {}

  /// Add the next values of the numbers.
  void add(const double* values) {
    add(values, 0, sums_.size());
    is_first_ = false;
  }
  /// Add the next values, which are a row of a table.
  template <std::size_t rows>
  void add_row(const RotorRows<rows>& table, std::size_t row) {
    for (std::size_t i = 0; i < sums_.size(); i += widest_lanes) {
      add(table.data() + rotor_offset(rows, i) + row * widest_lanes, i,
          std::min(sums_.size() - i, widest_lanes));
    }
    is_first_ = false;
  }
  /// Return the sum of each number.
  const std::vector<double>& sums() const { return sums_; }

 private:
  /// Add the next values of some numbers from the given one on.
  void add(const double* values, std::size_t first, std::size_t count) {
    double *const last = last_.data() + first, *const sums = sums_.data() + first;
    for (std::size_t i = 0; i < count; ++i) {
      const double size = std::abs(values[i]);
      if (!is_first_) sums[i] += std::abs(size - last[i]);
      last[i] = size;
    }
  }

  std::vector<double> last_, sums_;
  bool is_first_ = true;
};

}  // namespace quadcore
