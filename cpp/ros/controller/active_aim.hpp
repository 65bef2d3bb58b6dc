#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <variant>

#include "quadcore/control/inner_loop.hpp"
#include "quadcore/control/reference.hpp"

namespace quadcore::node {

/// Set point of a vehicle.
using Aim = std::variant<control::Reference, control::AttitudeThrust, control::RatesThrust>;

/// The set point at any time: first a shape, or without one the place at which the vehicle is first
/// observed; then the last request.
class ActiveAim {
 public:
  using Shape = std::shared_ptr<const control::ReferenceShape>;
  /// Makes a shape that begins at the end of another.
  using Begin = std::function<Shape(const control::Reference& from)>;

  explicit ActiveAim(Shape shape);

  /// Discards all requests.
  void begin();
  /// Follows a new shape from the next call of at() on.
  void follow(Begin begin) { next_ = std::move(begin); }
  void hold(const Aim& aim);

  /// \param t    time of the plant [s]
  /// \param now  present state of the vehicle
  Aim at(double t, const control::Odometry& now);

 private:
  Shape first_, shape_;
  double begun_ = 0;  ///< time of the shape's beginning [s]
  Begin next_;
  Aim held_;  ///< used without a shape
};

}  // namespace quadcore::node
