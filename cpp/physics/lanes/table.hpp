#pragma once

#include <cstddef>

#include "quaternion.hpp"

namespace quadcore::laws {

/// Numbers of a pack of vehicles, starting at the first of them: a row for each quantity, three for
/// a vector, nine (by columns) for a matrix. The distance of rows is `stride` numbers.
template <class T, std::size_t stride>
struct Table {
  const double* first;

  QUADCORE_LAW T number(std::size_t row) const { return load<T>(first + row * stride); }
  QUADCORE_LAW Vec3<T> vector(std::size_t row) const {
    return {number(row), number(row + 1), number(row + 2)};
  }
  QUADCORE_LAW Matrix3<T> matrix(std::size_t row) const {
    return {number(row),     number(row + 3), number(row + 6), number(row + 1), number(row + 4),
            number(row + 7), number(row + 2), number(row + 5), number(row + 8)};
  }
  QUADCORE_LAW Symmetric3<T> symmetric(std::size_t row) const {
    return {number(row),     number(row + 1), number(row + 2),
            number(row + 3), number(row + 4), number(row + 5)};
  }
};

}  // namespace quadcore::laws
