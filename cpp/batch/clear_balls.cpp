#include "clear_balls.hpp"

#include <cmath>
#include <utility>

namespace quadcore::batch {

ClearBalls::ClearBalls(std::vector<Obstacle> obstacles, std::size_t places, double reach)
    : obstacles_(std::move(obstacles)), reach_(reach), rows_(ClearRow::count * places) {
  const double radius = find_radius(Vector3d::Zero());
  for (std::size_t i = 0; i < places; ++i) column(i)[ClearRow::radius * widest_lanes] = radius;
}

bool ClearBalls::move(std::size_t vehicle, const double* position) {
  double* const ball = column(vehicle);
  Vector3d p_W;
  bool is_there = true;
  for (std::size_t k = 0; k < 3; ++k) {
    double& center = ball[(ClearRow::center_W + k) * widest_lanes];
    is_there &= center == position[k * widest_lanes];
    center = p_W[static_cast<Eigen::Index>(k)] = position[k * widest_lanes];
  }
  if (!is_there) ball[ClearRow::radius * widest_lanes] = find_radius(p_W);
  return !is_there;
}

double* ClearBalls::column(std::size_t vehicle) {
  return rows_.data() + vehicle / widest_lanes * ClearRow::count * widest_lanes +
         vehicle % widest_lanes;
}

double ClearBalls::find_radius(const Vector3d& center_W) const {
  constexpr double rounding = 1e-9;
  const double nearest = obstacles_.nearest(center_W);
  return nearest - reach_ - rounding * (1 + std::abs(nearest));
}

}  // namespace quadcore::batch
