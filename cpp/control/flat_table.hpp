#pragma once

#include <optional>

#include "flat_states.hpp"
#include "quadcore/control/flat_state.hpp"

namespace quadcore::control {

/// Flat states of a vehicle for up to widest_lanes references at once.
class FlatTable {
 public:
  FlatTable(const ModelledVehicle& model, bool with_drag);

  /// Set the reference of a column.
  void set(std::size_t column, const Reference& wanted);
  /// Compute the flat states of the first columns.
  void solve(std::size_t columns);
  /// Write the flat state of a column, or nothing if the attitude is undefined.
  void get_state(std::size_t column, std::optional<FlatState>& state) const;

 private:
  double* at(std::size_t row, std::size_t column) { return &rows_[row * widest_lanes + column]; }
  template <class Vector>
  void get(std::size_t row, std::size_t column, Vector&& vector) const;

  FlatVehicle vehicle_;
  double rows_[FlatRow::count * widest_lanes] = {};
};

}  // namespace quadcore::control
