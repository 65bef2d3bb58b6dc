#include "active_aim.hpp"

#include "references/set_points.hpp"

namespace quadcore::node {
namespace {

control::Reference make_hold(const control::Odometry& now) {
  control::Reference place;
  place.position = now.position;
  place.yaw = rpy_from_quaternion(now.orientation).z();
  return place;
}

}  // namespace

ActiveAim::ActiveAim(Shape shape) : first_(std::move(shape)) { begin(); }

void ActiveAim::begin() {
  shape_ = first_;
  begun_ = 0;
  next_ = nullptr;
  if (!shape_) follow([](const control::Reference& from) { return control::hold(from); });
}

void ActiveAim::hold(const Aim& aim) {
  shape_ = nullptr;
  next_ = nullptr;
  held_ = aim;
}

Aim ActiveAim::at(double t, const control::Odometry& now) {
  if (next_) {
    shape_ = next_(shape_ ? shape_->at(t - begun_) : make_hold(now));
    begun_ = t;
    next_ = nullptr;
  }
  return shape_ ? Aim(shape_->at(t - begun_)) : held_;
}

}  // namespace quadcore::node
