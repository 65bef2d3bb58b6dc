#pragma once

#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/rotor_layout.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Begins numbers where a whole pack can be read at once: an allocator as the standard containers
/// want it.
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

/// A table of numbers of the rotors: a row for each quantity (three for a vector), a column for
/// each rotor, laid out as rotor_layout.hpp says.
template <std::size_t rows>
class RotorRows {
 public:
  /// For so many rotors, all numbers zero.
  explicit RotorRows(std::size_t rotors) : rotors_(rotors), numbers_(size_of(rotors), 0.0) {}

  /// Numbers that such a table takes.
  static std::size_t size_of(std::size_t rotors) {
    return (rotors + widest_lanes - 1) / widest_lanes * widest_lanes * rows;
  }
  /// Columns that are rotors', without those that fill up the last block.
  std::size_t rotors() const { return rotors_; }
  /// All numbers, in the order that rotor_offset() tells.
  double* data() { return numbers_.data(); }
  /// The same to read.
  const double* data() const { return numbers_.data(); }

  /// The number of rotor i in a row; neither is checked.
  double& number(std::size_t row, std::size_t i) { return numbers_[offset(row, i)]; }
  /// The same to read.
  double number(std::size_t row, std::size_t i) const { return numbers_[offset(row, i)]; }
  /// The vector of rotor i whose x stands in a row, y and z in the next two.
  Vector3d vector(std::size_t row, std::size_t i) const {
    const double* x = data() + offset(row, i);
    return {x[0], x[widest_lanes], x[2 * widest_lanes]};
  }
  /// Writes such a vector.
  void set_vector(std::size_t row, std::size_t i, const Vector3d& v) {
    double* x = data() + offset(row, i);
    x[0] = v.x();
    x[widest_lanes] = v.y();
    x[2 * widest_lanes] = v.z();
  }
  /// Adds to such a vector.
  void add_vector(std::size_t row, std::size_t i, const Vector3d& v) {
    double* x = data() + offset(row, i);
    x[0] += v.x();
    x[widest_lanes] += v.y();
    x[2 * widest_lanes] += v.z();
  }
  /// The matrix of rotor i whose columns stand from a row on.
  Matrix3d matrix(std::size_t row, std::size_t i) const {
    Matrix3d m;
    m << vector(row, i), vector(row + 3, i), vector(row + 6, i);
    return m;
  }
  /// Writes such a matrix.
  void set_matrix(std::size_t row, std::size_t i, const Matrix3d& m) {
    set_vector(row, i, m.col(0));
    set_vector(row + 3, i, m.col(1));
    set_vector(row + 6, i, m.col(2));
  }
  /// Sets all numbers to zero.
  void clear() { std::fill(numbers_.begin(), numbers_.end(), 0.0); }

 private:
  std::size_t offset(std::size_t row, std::size_t i) const {
    return rotor_offset(rows, i) + row * widest_lanes;
  }

  std::size_t rotors_;
  LaneNumbers numbers_;
};

}  // namespace quadcore
