#pragma once

#include <doctest/doctest.h>

#include <cmath>

#include "quadcore/control/reference.hpp"

namespace quadcore::test {

using control::Reference;
using control::ReferenceShape;

/// Each derivative is that of the one before, by central differences.
inline void check_derivatives(const ReferenceShape& shape, double t) {
  constexpr double h = 1e-4;
  const Reference before = shape.at(t - h), now = shape.at(t), after = shape.at(t + h);
  const auto agree = [&](const Vector3d Reference::* of, const Vector3d Reference::* derivative) {
    const Vector3d slope = (after.*of - before.*of) / (2 * h);
    CHECK((slope - now.*derivative).norm() <= 2e-6 * (1 + (now.*derivative).norm()));
  };
  agree(&Reference::position, &Reference::velocity);
  agree(&Reference::velocity, &Reference::acceleration);
  agree(&Reference::acceleration, &Reference::jerk);
  agree(&Reference::jerk, &Reference::snap);
  const double turn = std::remainder(after.yaw - before.yaw, 2 * M_PI) / (2 * h);
  CHECK(turn == doctest::Approx(now.yaw_rate).epsilon(1e-5).scale(1));
  const double turn_rate = (after.yaw_rate - before.yaw_rate) / (2 * h);
  CHECK(turn_rate == doctest::Approx(now.yaw_acceleration).epsilon(1e-5).scale(1));
}

}  // namespace quadcore::test
