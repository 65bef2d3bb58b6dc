#pragma once

#include "tracking.hpp"

namespace quadcore::control {

/// Incremental nonlinear dynamic inversion (Smeur, Chu, de Croon, JGCD 2016; Tal, Karaman, IEEE
/// TCST 2021): instead of computing what the vehicle needs it adds to what the rotors exert now
/// what is still missing of the wanted accelerations, which are measured. Yaw, where the rotors'
/// own spin-up acts first, is left to the model.
class Indi final : public Law {
 public:
  struct Gains : TrackingGains {
    double filter;
  };
  static const Settings<Gains>& settings();
  static constexpr std::size_t memory_size = 15;

  Indi(const Belief& belief, const Gains& gains)
      : tracking_(belief, gains), filter_(gains.filter) {}

  Demand demand(const Instant& instant, double* memory) const override;

 private:
  /// The integral of the position's error, then what is filtered.
  enum : std::size_t { kIntegral, kVelocity = 3, kRate = 6, kForce = 9, kTorque = 12 };

  Tracking tracking_;
  double filter_;
};

}  // namespace quadcore::control
