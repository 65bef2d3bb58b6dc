#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <variant>

#include "quadcore/control/inner_loop.hpp"
#include "quadcore/control/reference.hpp"

namespace quadcore::node {

/// What a vehicle is to do.
using Aim = std::variant<control::Reference, control::AttitudeThrust, control::RatesThrust>;

/// What a vehicle is to do at any time: at first a shape, or, without one, to stay at the place at
/// which it is first seen; then whatever was asked for last.
class Guide {
 public:
  using Shape = std::shared_ptr<const control::ReferenceShape>;
  /// Makes a shape that begins where another ends.
  using Begin = std::function<Shape(const control::Reference& from)>;

  explicit Guide(Shape shape);

  /// Whatever was asked for is forgotten.
  void begin();
  /// From the next call of at() on.
  void follow(Begin begin) { next_ = std::move(begin); }
  void hold(const Aim& aim);

  /// \param t    time of the plant [s]
  /// \param now  where the vehicle is
  Aim at(double t, const control::Odometry& now);

 private:
  Shape first_, shape_;
  double begun_ = 0;  ///< time of the shape's beginning [s]
  Begin next_;
  Aim held_;  ///< where there is no shape
};

}  // namespace quadcore::node
