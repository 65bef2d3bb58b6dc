#pragma once

#include <array>
#include <vector>

#include "lanes/pack.hpp"

namespace quadcore {

/// Projected Gauss-Seidel sweeps over constraint rows in GazeboStep's order. A step solves twice
/// with the same rows, for poses and for velocities, and both solutions run in parallel. Each row
/// depends on the previous one, because all act on the frame, so the latency from row to row
/// determines the speed.
class Sweeps {
 public:
  /// A number for both solutions.
  using Two = laws::Pack<2>;
  /// Linear, angular.
  using Acceleration = std::array<Two, 6>;
  static constexpr std::size_t most_rows_of_hinge = 6;

  /// Data of a row in the two solutions.
  struct Solved {
    Two wanted;  ///< acceleration that the row requires
    Two multiplier;
  };
  /// Any row J a = wanted of up to two bodies.
  struct Row : Solved {
    int body[2];     ///< the second is -1 for the ground
    double J[2][6];  ///< Jacobian of each body
    double inverse_mass_J[2][6];
    double relaxation;  ///< relaxation divided by the row's diagonal
    double cfm;
    double low, high;  ///< bounds of the multiplier
    double friction;   ///< for a friction row: bound per multiplier of its normal
    int normal;        ///< for a friction row: the row of its normal, else -1
    bool smooth;       ///< whether its multiplier is smoothed
  };
  /// A row of a hinge without friction, damping or mixing. Most of its components are always zero.
  /// It contains the angular parts in child and parent, and their accelerations per unit of the
  /// multiplier, along the row's axis and about all three axes.
  struct HingeRow : Solved {
    double turn_C[3], turn_P[3];
    double angular_C[3], angular_P[3];
    double linear_C, linear_P;
    double relaxation;
  };
  /// Three rows for the anchor along the world's axes, two for the axis, one for a lock.
  struct Hinge {
    int child, parent;
    bool locked;
    std::array<HingeRow, most_rows_of_hinge> rows;
  };

  std::vector<Acceleration> bodies;  ///< accelerations by the constraints
  std::vector<Hinge> hinges;         ///< swept first
  std::vector<Row> rows;
  std::vector<std::size_t> order;  ///< order of `rows` in the sweeps
  Two smoothing{};                 ///< of contact multipliers: remaining fraction of the old value

  /// Sweep so many times over all rows, each time from hinges to rows.
  void sweep(int times);
  /// Sweep over rows starting at a position in `order`.
  void sweep_rows(int times, std::size_t begin);
};

}  // namespace quadcore
