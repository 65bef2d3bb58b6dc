#pragma once

#include <vector>

#include "quadcore/plugin/obstacle.hpp"

namespace quadcore {

/// A ball without obstacles around the last position that was examined, so that away from obstacles
/// a step costs one comparison, however many obstacles a world has.
class ClearBall {
 public:
  explicit ClearBall(std::vector<Obstacle> obstacles);

  /// Return whether there are no obstacles at all.
  bool is_empty() const { return obstacles_.empty(); }
  /// Return whether a ball [m] touches no obstacle. The answer does not depend on earlier calls.
  bool is_free(const Vector3d& center_W, double radius);
  /// Return the minimum of least_distance_to() of all obstacles from a point [m]; infinite without
  /// obstacles.
  double nearest(const Vector3d& p_W) const;

 private:
  std::vector<Obstacle> obstacles_;
  std::vector<double> outer_radii_;
  Vector3d center_W_ = Vector3d::Zero();
  double radius_;
};

}  // namespace quadcore
