#include "clear_ball.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace quadcore {
namespace {

/// Part of a distance that rounding errors do not exceed.
constexpr double rounding = 1e-9;

}  // namespace

ClearBall::ClearBall(std::vector<Obstacle> obstacles) : obstacles_(std::move(obstacles)) {
  for (const Obstacle& obstacle : obstacles_) outer_radii_.push_back(outer_radius(obstacle));
  radius_ = nearest(center_W_);
}

bool ClearBall::is_free(const Vector3d& center_W, double radius) {
  const double moved = (center_W - center_W_).norm();
  if (moved + radius + rounding * (1 + moved + radius) < radius_) return true;
  center_W_ = center_W;
  radius_ = nearest(center_W);
  return radius < radius_;
}

double ClearBall::nearest(const Vector3d& p_W) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outer_radii_.size(); ++i) {
    const Obstacle& obstacle = obstacles_[i];
    const double bound = nearest + outer_radii_[i];
    if (bound >= 0 && !((p_W - obstacle.position_W).squaredNorm() > bound * bound)) {
      nearest = std::min(nearest, least_distance_to(obstacle, p_W));
    }
  }
  return nearest;
}

}  // namespace quadcore
