#pragma once

#include "lanes/pack.hpp"
#include "quadcore/plugin/rotor_layout.hpp"

namespace quadcore::laws {

/// Rows of the total variation of a number: its last magnitude, and the sum of the changes of its
/// magnitude.
struct VariationRow {
  enum : std::size_t { last, sum, count };
};

/// Take the first value of a number.
/// \param rows  table of VariationRow
template <class T>
QUADCORE_LAW void begin_variation(double* rows, T value) {
  store(rows + VariationRow::last * widest_lanes, absolute(value));
}

/// Add the next value of a number, bit-identical to TotalVariation.
template <class T>
QUADCORE_LAW void add_variation(double* rows, T value) {
  double* const last = rows + VariationRow::last * widest_lanes;
  double* const sum = rows + VariationRow::sum * widest_lanes;
  const T size = absolute(value);
  store(sum, load<T>(sum) + absolute(size - load<T>(last)));
  store(last, size);
}

}  // namespace quadcore::laws
