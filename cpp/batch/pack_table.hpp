#pragma once

#include "quadcore/plugin/rotor_rows.hpp"

namespace quadcore::batch {

/// Numbers of the vehicles of a block, as a struct of packs for each W vehicles.
class PackTable {
 public:
  PackTable(int width, std::size_t rows)
      : width_(static_cast<std::size_t>(width)), rows_(rows), numbers_(rows * widest_lanes) {}

  double* data() { return numbers_.data(); }
  std::size_t size() const { return numbers_.size(); }
  /// Convert to and from the numbers of one vehicle.
  void put(std::size_t lane, const double* column) {
    double* const to = first(lane);
    for (std::size_t row = 0; row < rows_; ++row) to[row * width_] = column[row];
  }
  void get(std::size_t lane, double* column) const {
    const double* const from = &numbers_[offset(lane)];
    for (std::size_t row = 0; row < rows_; ++row) column[row] = from[row * width_];
  }
  /// Add a row to numbers of all vehicles.
  void add_row(std::size_t row, double* sums) const {
    for (std::size_t part = 0; part < widest_lanes / width_; ++part) {
      const double* const from = &numbers_[(part * rows_ + row) * width_];
      for (std::size_t i = 0; i < width_; ++i) *sums++ += from[i];
    }
  }
  /// Set the numbers of all vehicles.
  void fill(const double* column);

 private:
  std::size_t offset(std::size_t lane) const {
    return lane / width_ * rows_ * width_ + lane % width_;
  }
  double* first(std::size_t lane) { return &numbers_[offset(lane)]; }

  std::size_t width_, rows_;
  LaneNumbers numbers_;
};

}  // namespace quadcore::batch
