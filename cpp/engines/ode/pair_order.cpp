#include "pair_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

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

PairOrder::PairOrder(const std::vector<Bounds>& boxes) : still_(boxes.size()) {
  for (const Bounds& box : boxes) {
    models_.push_back({box, level_of(box), static_cast<int>(models_.size())});
  }
}

/// Each new model is put to the front of the space's list. So is each that moves in a step, the
/// newest first. The space goes through the list from its end.
void PairOrder::sort_moving(const std::vector<MovingModel>& moving) {
  ranked_.resize(moving.size());
  std::iota(ranked_.begin(), ranked_.end(), 0);
  std::sort(ranked_.begin(), ranked_.end(), [&moving](int one, int other) {
    const double unmoved = moving[static_cast<std::size_t>(one)].unmoved;
    const double of_other = moving[static_cast<std::size_t>(other)].unmoved;
    if (unmoved != of_other) return unmoved > of_other;
    return std::isinf(unmoved) ? one < other : one > other;
  });
}

const std::vector<ModelPair>& PairOrder::find(const std::vector<MovingModel>& moving) {
  models_.resize(still_);
  for (const MovingModel& model : moving) models_.push_back({model.box, level_of(model.box), 0});
  sort_moving(moving);
  int rank = static_cast<int>(still_);
  for (const int i : ranked_) models_[still_ + static_cast<std::size_t>(i)].rank = rank++;
  found_.clear();
  pairs_.clear();
  for (std::size_t i = still_; i < models_.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) add(i, k);
  }
  std::sort(found_.begin(), found_.end(),
            [](const Found& one, const Found& other) { return one.place < other.place; });
  for (const Found& found : found_) pairs_.push_back(found.pair);
  return pairs_;
}

/// Each model finds those of its own level and of larger ones, by level and cell, and in a cell the
/// last of the list first. A pair of one level is found by the first of the list. Models beyond the
/// levels come at last, in the order of the list.
void PairOrder::add(std::size_t one, std::size_t other) {
  if (!overlap(models_[one].box, models_[other].box)) return;
  const auto place_of = [this](std::size_t i) {
    return std::make_pair(models_[i].level, models_[i].rank);
  };
  if (place_of(other) < place_of(one)) std::swap(one, other);
  const Sized &finder = models_[one], &found = models_[other];
  std::array<int, 7> place = {0, finder.rank, found.level, 0, 0, 0, 0};
  if (found.level == beyond_levels) {
    place = {1, finder.rank, found.rank, 0, 0, 0, 0};
  } else {
    int* const cell = place.data() + 3;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cell[axis] = first_common_cell(finder.box, found.box, axis, found.level);
    }
    place[6] = -found.rank;
  }
  found_.push_back({place, {one, other}});
}

}  // namespace quadcore
