#pragma once

#include <limits>
#include <vector>

#include "quadcore/lane_laws.hpp"
#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Says of a plugin that its update() does nothing in a motion within these bounds, unless there is
/// a message that it has not heard.
struct Quiet {
  double fastest = std::numeric_limits<double>::infinity();  ///< every joint is slower [rad/s]
  bool no_tilt = false;  ///< no rotor's normal points below the horizon
  /// A number that is not zero once the plugin has warned of a joint beyond `fastest`, which then
  /// no longer holds; null if it always holds.
  const double* has_said_fast = nullptr;
  /// The same for `no_tilt`.
  const double* has_said_tilt = nullptr;
};

/// Laws that plugins of quadcore hand out beside their forces(), for engines that evaluate them
/// themselves. What they point to lies in the plugins or in their state.
struct ForceLaws {
  std::vector<RotorForces> rotor_forces;    ///< thrust, drag, reaction torques
  std::vector<FrameDrag> frame_drags;       ///< of the airframe
  std::vector<MotorTorques> motor_torques;  ///< on the joints
  std::vector<Quiet> quiet;                 ///< of plugins that have an update()
  /// Every plugin that has an update() is in `quiet`, and the laws are complete.
  bool all_quiet = false;
  bool complete = false;  ///< nothing else acts on the vehicle, and the air stands still
};

}  // namespace quadcore
