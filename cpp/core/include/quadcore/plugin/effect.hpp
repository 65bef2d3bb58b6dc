#pragma once

/// \file
/// What a tag's number changes. Free of Eigen and of code, so that files compiled for one processor
/// may include it.

namespace quadcore {

/// A property of the vehicle that grows with a tag's number. Studies vary it by scaling these tags.
enum class Effect {
  none,    ///< none of these
  thrust,  ///< thrust and reaction torque of the rotors
  drag,    ///< resistance of the air
  lag,     ///< time constant of the motors
};

}  // namespace quadcore
