#include "quadcore/control/reference_preview.hpp"

#include <cmath>

#include "flat_table.hpp"

namespace quadcore::control {

ReferencePreview::ReferencePreview(const Controller& controller) {
  using Feeds = WrenchController::Feeds;
  const Feeds feeds = controller.feeds();
  if (feeds == Feeds::nothing) return;
  table_ = std::make_unique<FlatTable>(controller.model(), feeds == Feeds::flat_state_with_drag);
}

std::optional<FlatState> ReferencePreview::Point::flat_state() const {
  if (!flat) return std::nullopt;
  return flat->state(column);
}

ReferencePreview::ReferencePreview(ReferencePreview&&) noexcept = default;
ReferencePreview::~ReferencePreview() = default;

const ReferencePreview::Point& ReferencePreview::at(double time, const ReferenceShape& reference,
                                                    const ListTimes& list_times) {
  const auto is_at = [&](std::size_t point) {
    return point < points_.size() && points_[point].time == time &&
           reference_ == reference.serial();
  };
  if (!is_at(present_)) ++present_;
  if (!is_at(present_)) look_ahead(reference, list_times);
  return points_[present_];
}

void ReferencePreview::look_ahead(const ReferenceShape& reference, const ListTimes& list_times) {
  reference_ = 0;
  present_ = 0;
  const std::size_t count = table_ ? widest_lanes : 1;
  double times[widest_lanes];
  list_times(times, count);
  points_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    Point& point = points_[i];
    point.time = times[i];
    point.wanted = reference.at(times[i]);
    point.of_yaw = sincos(point.wanted.yaw);
    if (table_) table_->set(i, point.wanted, point.of_yaw);
  }
  if (table_) table_->solve(count);
  for (std::size_t i = 0; i < count; ++i) {
    points_[i].flat = table_ && table_->is_defined(i) ? table_.get() : nullptr;
    points_[i].column = i;
  }
  reference_ = reference.serial();
}

const elementary::SineCosine& ReferencePreview::sincos(double yaw) {
  if (yaw != yaw_ || std::signbit(yaw) != std::signbit(yaw_)) {
    yaw_ = yaw;
    of_yaw_ = elementary::sincos(yaw);
  }
  return of_yaw_;
}

}  // namespace quadcore::control
