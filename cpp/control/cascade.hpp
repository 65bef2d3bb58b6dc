#pragma once

#include <optional>

#include "quadcore/control/flat_state.hpp"
#include "quadcore/control/law.hpp"

namespace quadcore::control {

/// The cascade of thesis chapter 2: an outer loop on the position commands roll, pitch and thrust,
/// an inner one on roll, pitch and yaw the torques, with feedback linearisation. Without
/// compensation it is eqs. (2.43)-(2.51), with it (2.52)-(2.57); with integrals the PID of
/// section 6.2.
class Cascade final : public Law {
 public:
  struct Gains {
    double scale;
    double kp_xy, ki_xy, kd_xy, kp_z, ki_z, kd_z;
    double kp_rp, ki_rp, kd_rp, kp_yaw, ki_yaw, kd_yaw;
    bool feed_forward, drag, gyroscopic, flat_rates;
  };
  static const Settings<Gains>& settings();
  static constexpr std::size_t memory_size = 6;

  Cascade(const Belief& belief, const Gains& gains);

  Demand demand(const Instant& instant, double* memory) const override;

 private:
  /// Integrals of the errors of position and angles.
  enum : std::size_t { kPosition, kAngles = 3 };

  Vector3d acceleration(const Instant& instant, double* memory) const;
  Vector3d torque(const Instant& instant, const std::optional<FlatState>& flat, const Vector3d& rpy,
                  const Vector3d& wanted_rpy, double* memory) const;

  Belief belief_;
  Gains gains_;
  Vector3d outer_p_, outer_i_, outer_d_, inner_p_, inner_i_, inner_d_;
};

}  // namespace quadcore::control
