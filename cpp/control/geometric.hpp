#pragma once

#include "tracking.hpp"

namespace quadcore::control {

/// Tracking control on SE(3) (Lee, Leok, McClamroch, CDC 2010), with the error of the attitude as a
/// quaternion, and with what the reference asks for fed forward.
class Geometric final : public Law {
 public:
  using Gains = TrackingGains;
  static const Settings<Gains>& settings();

  Geometric(const Belief& belief, const Gains& gains) : tracking_(belief, gains) {}

  static constexpr std::size_t memory_size = 3;
  Demand demand(const Instant& instant, double* memory) const override;

 private:
  Tracking tracking_;
};

}  // namespace quadcore::control
