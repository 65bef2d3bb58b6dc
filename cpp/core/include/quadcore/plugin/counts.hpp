#pragma once

#include <cstddef>
#include <cstdint>

#include "quadcore/plugin/error.hpp"

/// \file
/// Whole numbers in a plugin's state, which consists of doubles. A restored snapshot may contain
/// any values, so every value that becomes an index or a loop count is checked.

namespace quadcore {

/// Return a count stored in the state. Throws Error unless it is from 0 to `most`, by default the
/// number up to which a double represents every whole number.
inline std::uint64_t count_of(double number, std::uint64_t most = std::uint64_t{1} << 53) {
  if (number >= 0 && number <= static_cast<double>(most)) {
    return static_cast<std::uint64_t>(number);
  }
  throw Error(
      "a counter in the plugin's state is damaged. Reset the simulation or restore another "
      "snapshot.");
}

/// Return the index of the entry with this count in a ring buffer of the given size.
inline std::size_t ring_index(double count, std::size_t places) {
  return static_cast<std::size_t>(count_of(count) % places);
}

}  // namespace quadcore
