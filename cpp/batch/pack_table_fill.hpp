#pragma once

#include <cstddef>

/// \file
/// Contains neither Eigen nor code, so that files compiled for a specific processor can include it.

namespace quadcore::batch {

/// Set the numbers of all vehicles in a PackTable for packs of W.
/// \param column  numbers of one vehicle
template <int W>
void fill_packs(const double* column, std::size_t rows, double* table);

}  // namespace quadcore::batch
