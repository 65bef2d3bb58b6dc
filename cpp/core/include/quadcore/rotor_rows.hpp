#pragma once

#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

#include "quadcore/export.hpp"
#include "quadcore/rotor_layout.hpp"
#include "quadcore/spatial.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Begins numbers where a whole pack can be read at once.
template <class T>
struct LaneAllocator {
  using value_type = T;
  static constexpr std::align_val_t alignment{widest_lanes * sizeof(double)};
  LaneAllocator() = default;
  template <class Other>
  explicit LaneAllocator(const LaneAllocator<Other>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), alignment)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, alignment); }
  bool operator==(const LaneAllocator&) const { return true; }
  bool operator!=(const LaneAllocator&) const { return false; }
};
using LaneNumbers = std::vector<double, LaneAllocator<double>>;

/// A table of numbers of the rotors: a row for each quantity (three for a vector), a column for
/// each rotor, laid out as rotor_layout.hpp says.
template <std::size_t rows>
class RotorRows {
 public:
  explicit RotorRows(std::size_t rotors) : rotors_(rotors), numbers_(size_of(rotors), 0.0) {}

  /// Numbers that such a table takes.
  static std::size_t size_of(std::size_t rotors) {
    return (rotors + widest_lanes - 1) / widest_lanes * widest_lanes * rows;
  }
  std::size_t rotors() const { return rotors_; }
  double* data() { return numbers_.data(); }
  const double* data() const { return numbers_.data(); }

  double& number(std::size_t row, std::size_t i) { return numbers_[offset(row, i)]; }
  double number(std::size_t row, std::size_t i) const { return numbers_[offset(row, i)]; }
  /// The vector of rotor i whose x stands in a row, y and z in the next two.
  Vector3d vector(std::size_t row, std::size_t i) const {
    const double* x = data() + offset(row, i);
    return {x[0], x[widest_lanes], x[2 * widest_lanes]};
  }
  void set_vector(std::size_t row, std::size_t i, const Vector3d& v) {
    double* x = data() + offset(row, i);
    x[0] = v.x();
    x[widest_lanes] = v.y();
    x[2 * widest_lanes] = v.z();
  }
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
  void set_matrix(std::size_t row, std::size_t i, const Matrix3d& m) {
    set_vector(row, i, m.col(0));
    set_vector(row + 3, i, m.col(1));
    set_vector(row + 6, i, m.col(2));
  }
  void clear() { std::fill(numbers_.begin(), numbers_.end(), 0.0); }

 private:
  std::size_t offset(std::size_t row, std::size_t i) const {
    return rotor_offset(rows, i) + row * widest_lanes;
  }

  std::size_t rotors_;
  LaneNumbers numbers_;
};

}  // namespace quadcore
