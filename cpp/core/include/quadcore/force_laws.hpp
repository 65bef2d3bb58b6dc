#pragma once

#include <vector>

#include "quadcore/export.hpp"
#include "quadcore/lane_laws.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Laws that plugins hand out beside their forces(), for engines that evaluate them themselves.
/// What they point to lies in the plugins or in their state.
struct ForceLaws {
  std::vector<RotorForces> rotor_forces;
  std::vector<FrameDrag> frame_drags;
  std::vector<MotorTorques> motor_torques;
  bool complete = false;  ///< nothing else acts on the vehicle, and the air stands still
};

}  // namespace quadcore
