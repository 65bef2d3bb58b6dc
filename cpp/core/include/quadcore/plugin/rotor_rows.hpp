#pragma once

#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/rotor_layout.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Allocator for standard containers that aligns numbers such that a whole pack can be read at
/// once.
template <class T>
struct LaneAllocator {
  /// \cond
  using value_type = T;
  static constexpr std::align_val_t alignment{widest_lanes * sizeof(double)};
  LaneAllocator() = default;
  template <class Other>
  explicit LaneAllocator(const LaneAllocator<Other>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), alignment)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, alignment); }
  bool operator==(const LaneAllocator&) const { return true; }
  bool operator!=(const LaneAllocator&) const { return false; }
  /// \endcond
};
/// Numbers in packs of widest_lanes.
using LaneNumbers = std::vector<double, LaneAllocator<double>>;

/// A table of rotor quantities with a row for each quantity (three for a vector) and a column for
/// each rotor, in the layout of rotor_layout.hpp.
template <std::size_t rows>
class RotorRows {
 public:
  /// Create a table of zeros for so many rotors.
  explicit RotorRows(std::size_t rotors) : rotors_(rotors), numbers_(size_of(rotors), 0.0) {}

  /// Return the number of values in the table.
  static std::size_t size_of(std::size_t rotors) {
    return (rotors + widest_lanes - 1) / widest_lanes * widest_lanes * rows;
  }
  /// Return the number of rotors, without the columns that fill the last block.
  std::size_t rotors() const { return rotors_; }
  /// Return all values in the order of rotor_offset().
  double* data() { return numbers_.data(); }
  /// The same to read.
  const double* data() const { return numbers_.data(); }

  /// Return the value of rotor i in a row, without checking the indices.
  double& number(std::size_t row, std::size_t i) { return numbers_[offset(row, i)]; }
  /// The same to read.
  double number(std::size_t row, std::size_t i) const { return numbers_[offset(row, i)]; }
  /// Return the vector of rotor i with x in the given row, and y and z in the next two.
  Vector3d vector(std::size_t row, std::size_t i) const {
    const double* x = data() + offset(row, i);
    return {x[0], x[widest_lanes], x[2 * widest_lanes]};
  }
  /// Write such a vector.
  void set_vector(std::size_t row, std::size_t i, const Vector3d& v) {
    double* x = data() + offset(row, i);
    x[0] = v.x();
    x[widest_lanes] = v.y();
    x[2 * widest_lanes] = v.z();
  }
  /// Add to such a vector.
  void add_vector(std::size_t row, std::size_t i, const Vector3d& v) {
    double* x = data() + offset(row, i);
    x[0] += v.x();
    x[widest_lanes] += v.y();
    x[2 * widest_lanes] += v.z();
  }
  /// Return the matrix of rotor i, stored by columns from the given row.
  Matrix3d matrix(std::size_t row, std::size_t i) const {
    Matrix3d m;
    m << vector(row, i), vector(row + 3, i), vector(row + 6, i);
    return m;
  }
  /// Write such a matrix.
  void set_matrix(std::size_t row, std::size_t i, const Matrix3d& m) {
    set_vector(row, i, m.col(0));
    set_vector(row + 3, i, m.col(1));
    set_vector(row + 6, i, m.col(2));
  }
  /// Set all values to zero.
  void clear() { std::fill(numbers_.begin(), numbers_.end(), 0.0); }

 private:
  std::size_t offset(std::size_t row, std::size_t i) const {
    return rotor_offset(rows, i) + row * widest_lanes;
  }

  std::size_t rotors_;
  LaneNumbers numbers_;
};

}  // namespace quadcore
