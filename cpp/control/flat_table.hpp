#pragma once

#include "controller_numbers.hpp"
#include "flat_states.hpp"
#include "quadcore/control/flat_state.hpp"
#include "quadcore/plugin/elementary.hpp"

namespace quadcore::control {

/// Flat states of a vehicle for up to widest_lanes references at once.
class FlatTable {
 public:
  FlatTable(const ModelledVehicle& model, bool with_drag);

  /// Set the reference of a column.
  /// \param of_yaw  sine and cosine of its yaw
  void set(std::size_t column, const Reference& wanted, const elementary::SineCosine& of_yaw);
  /// Compute the flat states of the first columns.
  void solve(std::size_t columns);
  /// Return whether the attitude of a column is defined.
  bool is_defined(std::size_t column) const;
  /// Return the flat state of a column.
  FlatState state(std::size_t column) const;
  /// Return the numbers of a reference with the flat state of its column.
  WantedNumbers<double> numbers(const Reference& wanted, std::size_t column) const;

 private:
  double* at(std::size_t row, std::size_t column) { return &rows_[row * widest_lanes + column]; }
  double number(std::size_t row, std::size_t column) const {
    return rows_[row * widest_lanes + column];
  }
  Vec3<double> vector(std::size_t row, std::size_t column) const {
    return {number(row, column), number(row + 1, column), number(row + 2, column)};
  }

  FlatVehicle vehicle_;
  int width_;  ///< how many columns are solved at once
  double rows_[FlatRow::count * widest_lanes] = {};
};

}  // namespace quadcore::control
