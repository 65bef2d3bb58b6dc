#pragma once

/// \file
/// The property of the vehicle that a tag changes. Contains neither Eigen nor code, so that files
/// compiled for a specific processor can include it.

namespace quadcore {

/// Property of the vehicle that grows with a tag's value. Studies vary it by scaling these tags.
enum class Effect {
  none,    ///< none of these
  thrust,  ///< thrust and reaction torque of the rotors
  drag,    ///< resistance of the air
  lag,     ///< time constant of the motors
};

}  // namespace quadcore
