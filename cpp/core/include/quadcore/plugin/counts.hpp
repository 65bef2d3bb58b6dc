#pragma once

#include <cstddef>
#include <cstdint>

#include "quadcore/plugin/error.hpp"

/// \file
/// Whole numbers in a plugin's state, whose numbers are all doubles. A state comes from outside
/// when a snapshot is restored, so what becomes an index or a number of passes is checked.

namespace quadcore {

/// The count that a number of the state holds. Throws Error unless it lies from 0 to `most`, by
/// default the number up to which a double holds every whole number.
inline std::uint64_t count_of(double number, std::uint64_t most = std::uint64_t{1} << 53) {
  if (number >= 0 && number <= static_cast<double>(most)) {
    return static_cast<std::uint64_t>(number);
  }
  throw Error("a count in the plugin's memory is damaged. Reset, or restore another snapshot.");
}

/// Where the entry of this count lies in a ring of so many places.
inline std::size_t ring_index(double count, std::size_t places) {
  return static_cast<std::size_t>(count_of(count) % places);
}

}  // namespace quadcore
