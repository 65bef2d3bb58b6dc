#pragma once

#include "block.hpp"
#include "ode/hinged_tree.hpp"

/// \file
/// Vehicles of a block as bodies on hinges, all attached to the frame: the engine gazebo11 in
/// flight. Contains neither Eigen nor code, so that files compiled for a specific processor can
/// include it.

namespace quadcore::batch {

/// Rows after those of ConstantRow, of which such vehicles use those of the force laws:
/// BodyConstant of each body. Rows of their state: BodyRow of each body.
struct HingedRow {
  static constexpr std::size_t constants(std::size_t rotors) {
    return ConstantRow::count(rotors) + (rotors + 1) * BodyConstant::count;
  }
  static constexpr std::size_t state(std::size_t rotors) { return (rotors + 1) * BodyRow::count; }
};

/// Rows that show_hinged_block() writes after those of StateRow for each rotor, without the angles:
/// the axis, and the orientation in the frame by columns.
struct TurnedRow {
  enum : std::size_t { axis_F, R_FR = 3, count = 12 };

  static constexpr std::size_t rotor(std::size_t row, std::size_t i, std::size_t rotors) {
    return StateRow::count(rotors) + i * count + row;
  }
  /// Return the number of written rows, which is at least HingedRow::state().
  static constexpr std::size_t end(std::size_t rotors) { return rotor(0, rotors, rotors); }
};

/// Like step_block(), with gazebo11's steps. A block's work memory is for the written rows, then
/// for BodyWork and SoftRows of each body.
template <int W>
void step_hinged_block(const Block& block, std::int64_t count, double dt);

template <int W>
void show_hinged_block(const Block& block, double* shown);

}  // namespace quadcore::batch
