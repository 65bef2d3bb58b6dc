#pragma once

#include <limits>
#include <vector>

#include "quadcore/lane_laws.hpp"
#include "quadcore/odometry_errors.hpp"
#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Bounds of the motion within which a plugin's update() has no effect, unless it has unread
/// messages or published one in the last update().
struct Quiet {
  /// `fastest` without a limit.
  static constexpr double unlimited = std::numeric_limits<double>::infinity();

  double fastest = unlimited;  ///< upper limit of all joint rates [rad/s]
  bool no_tilt = false;        ///< whether no rotor's normal may point below the horizon
  /// State value that is nonzero once the plugin has warned about a joint beyond `fastest`, which
  /// then no longer applies; null if it always applies.
  const double* has_said_fast = nullptr;
  /// The same for `no_tilt`.
  const double* has_said_tilt = nullptr;

  /// Return whether `fastest` applies now.
  bool bounds_rates() const { return fastest < unlimited && !is_set(has_said_fast); }
  /// Return whether `no_tilt` applies now.
  bool bounds_tilt() const { return no_tilt && !is_set(has_said_tilt); }

  /// Return whether a state value tells that a plugin has warned.
  static bool is_set(const double* has_said) { return has_said && *has_said != 0; }
};

/// Force laws and sensors that quadcore's own plugins provide in addition to forces() and sense(),
/// for engines and batches that evaluate them directly. Their pointers refer to the plugins or
/// their state.
struct ForceLaws {
  std::vector<RotorForces> rotor_forces;    ///< thrust, drag, reaction torques
  std::vector<FrameDrag> frame_drags;       ///< parasitic drag of the airframe
  std::vector<AirframeLaws> airframes;      ///< other loads of the air on the airframe
  std::vector<MotorTorques> motor_torques;  ///< torques on the joints
  std::vector<Quiet> quiet;                 ///< bounds for plugins with an update()
  std::vector<OdometrySensor> odometry;     ///< sensors of odometry
  /// Whether all plugins with an update() are in `quiet` and the laws are complete.
  bool all_quiet = false;
  bool complete = false;  ///< whether nothing else acts on the vehicle and the air is at rest
};

}  // namespace quadcore
