#pragma once

#include <array>
#include <vector>

#include "constraint_rows.hpp"

namespace quadcore {

/// Projected Gauss-Seidel sweeps over hinges alone, without friction, damping or mixing: no row is
/// bounded, and most components of a row are zero whatever the state. Each sum has the order that
/// GazeboStep's own sweeps give it, from which such components are left out: the same bytes in a
/// fraction of the time. A row waits for the one before, since all meet in the frame, and what
/// there is to gain is a short way from row to row.
class HingeSweeps {
 public:
  using Vector6 = ConstraintRow::Vector6;
  static constexpr std::size_t rows_of_hinge = 5;

  /// A row: its angular parts in child and parent, and what a unit of its multiplier accelerates
  /// them by, along the row's own axis and about all three.
  struct Row {
    Vector3d turn_C, turn_P;
    Vector3d angular_C, angular_P;
    double linear_C, linear_P;
    double relaxation;  ///< over the row's diagonal
    double wanted;      ///< acceleration that the row asks for
    double multiplier;
  };
  /// Three rows for the anchor, along the world's axes, two for the axis.
  struct HingeRows {
    Vector6 *child, *parent;  ///< accelerations by the constraints
    std::array<Row, rows_of_hinge> rows;
  };

  std::vector<HingeRows> hinges;  ///< in the order in which they are swept

  void sweep(int times);
};

}  // namespace quadcore
