#pragma once

#include <array>
#include <vector>

#include "lanes/pack.hpp"

namespace quadcore {

/// Projected Gauss-Seidel sweeps over constraint rows, in GazeboStep's order of rows. A step solves
/// twice with the same rows, for the poses and for the velocities: both at once, side by side. A
/// row waits for the one before, since all meet in the frame, and what there is to gain is a short
/// way from row to row.
class Sweeps {
 public:
  /// A number of both solves.
  using Two = laws::Pack<2>;
  /// Linear, angular.
  using Acceleration = std::array<Two, 6>;
  static constexpr std::size_t most_rows_of_hinge = 6;

  /// What every row has of its own in the two solves.
  struct Solved {
    Two wanted;  ///< acceleration that the row asks for
    Two multiplier;
  };
  /// Any row J a = wanted of up to two bodies.
  struct Row : Solved {
    int body[2];     ///< the second is -1 for the ground
    double J[2][6];  ///< for each body
    double inverse_mass_J[2][6];
    double relaxation;  ///< over the row's diagonal
    double cfm;
    double low, high;  ///< bounds of the multiplier
    double friction;   ///< of a friction row: bound per multiplier of its normal
    int normal;        ///< of a friction row: the row of its normal, else -1
    bool smooth;       ///< whether its multiplier is smoothed
  };
  /// A row of a hinge without friction, damping or mixing, most components of which are zero
  /// whatever the state: the angular parts in child and parent, and what a unit of the multiplier
  /// accelerates them by, along the row's own axis and about all three.
  struct HingeRow : Solved {
    double turn_C[3], turn_P[3];
    double angular_C[3], angular_P[3];
    double linear_C, linear_P;
    double relaxation;
  };
  /// Three rows for the anchor, along the world's axes, two for the axis, one for a lock.
  struct Hinge {
    int child, parent;
    bool locked;
    std::array<HingeRow, most_rows_of_hinge> rows;
  };

  std::vector<Acceleration> bodies;  ///< by the constraints
  std::vector<Hinge> hinges;         ///< swept first
  std::vector<Row> rows;
  std::vector<std::size_t> order;  ///< of `rows`, as they are swept
  Two smoothing{};                 ///< of contact multipliers: the part of the old that stays

  /// Sweeps so many times over all, each time from hinges to rows.
  void sweep(int times);
  /// The same over rows from a place in `order` on.
  void sweep_rows(int times, std::size_t begin);
};

}  // namespace quadcore
