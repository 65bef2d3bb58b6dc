#include "pair_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadcore {
namespace {

// Levels of Gazebo's hash space; the cells of a level have sides of 2^level m.
constexpr int lowest_level = -2, highest_level = 8;
/// Level of a model that is too large for the cells.
constexpr int beyond_levels = std::numeric_limits<int>::max();

/// Return the level whose cells are at least as long as the longest side of a box.
int level_of(const Bounds& box) {
  const dReal longest = std::max({box[1] - box[0], box[3] - box[2], box[5] - box[4]});
  if (!std::isfinite(longest)) return beyond_levels;
  int level = 0;
  std::frexp(longest, &level);
  return level > highest_level ? beyond_levels : std::max(level, lowest_level);
}

/// Return the first cell along an axis that two boxes share.
int first_common_cell(const Bounds& one, const Bounds& other, std::size_t axis, int level) {
  const dReal later = std::max(one[2 * axis], other[2 * axis]);
  return static_cast<int>(std::floor(std::ldexp(later, -level)));
}

}  // namespace

void extend(Bounds& box, const Bounds& other) {
  for (std::size_t i = 0; i < 6; i += 2) {
    box[i] = std::min(box[i], other[i]);
    box[i + 1] = std::max(box[i + 1], other[i + 1]);
  }
}

bool overlap(const Bounds& one, const Bounds& other) {
  for (std::size_t i = 0; i < 6; i += 2) {
    if (one[i] > other[i + 1] || one[i + 1] < other[i]) return false;
  }
  return true;
}

PairOrder::PairOrder(std::vector<Bounds> boxes) {
  for (const Bounds& box : boxes) models_.push_back({box, level_of(box)});
}

/// Smaller models come first, the oldest first; they find the vehicle. The vehicle then finds the
/// larger ones by level and cell, the newest of a cell first, and at last those beyond the levels,
/// the oldest first.
const std::vector<ModelPair>& PairOrder::find(const Bounds& vehicle) {
  found_.clear();
  pairs_.clear();
  const int own_level = level_of(vehicle);
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const auto& [box, level] = models_[i];
    if (!overlap(vehicle, box)) continue;
    const int age = static_cast<int>(i);
    const int group = level <= own_level ? lowest_level - 1 : level;
    const bool in_cells = level > own_level && level != beyond_levels;
    std::array<int, 5> place = {group, 0, 0, 0, age};
    for (std::size_t axis = 0; in_cells && axis < 3; ++axis) {
      place[1 + axis] = first_common_cell(vehicle, box, axis, level);
    }
    if (in_cells) place[4] = -age;
    found_.push_back({place, {i, group < lowest_level}});
  }
  std::sort(found_.begin(), found_.end(),
            [](const Found& one, const Found& other) { return one.place < other.place; });
  for (const Found& found : found_) pairs_.push_back(found.pair);
  return pairs_;
}

}  // namespace quadcore
