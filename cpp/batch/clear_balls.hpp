#pragma once

#include <vector>

#include "block.hpp"
#include "clear_ball.hpp"
#include "quadcore/plugin/rotor_rows.hpp"

namespace quadcore::batch {

/// For each vehicle of a batch, a ball without obstacles in which its centre of mass may move.
class ClearBalls {
 public:
  /// \param places  number of vehicles, a multiple of widest_lanes
  /// \param reach   maximum reach of the vehicles from their centre of mass [m]
  ClearBalls(std::vector<Obstacle> obstacles, std::size_t places, double reach);

  /// Return a block's table of ClearRow.
  const double* of_block(std::size_t block) const {
    return rows_.data() + block * ClearRow::count * widest_lanes;
  }
  /// Move the ball of a vehicle to its position, a column of a table. Returns false if the ball was
  /// already there.
  bool move(std::size_t vehicle, const double* position);

 private:
  double* column(std::size_t vehicle);
  double find_radius(const Vector3d& center_W) const;

  ClearBall obstacles_;
  double reach_;
  LaneNumbers rows_;  ///< table of ClearRow
};

}  // namespace quadcore::batch
