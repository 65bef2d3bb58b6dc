#pragma once

#include <algorithm>
#include <cmath>

#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/tags.hpp"

namespace quadcore::control {

constexpr double degrees_per_radian = 180 / M_PI;
constexpr double crazyflie_full = 65535;  ///< maximum motor command of the Crazyflie firmware

inline double clamp_within(double value, double limit) { return std::clamp(value, -limit, limit); }

/// Specify a non-negative gain or limit of a firmware.
/// \param parameter  its name in the firmware
inline TagSpec firmware_gain(const char* name, const char* unit, const char* fallback,
                             const char* meaning, const char* parameter) {
  return TagSpec::number(name, unit, fallback, meaning).at_least(0).from(parameter);
}

/// Return a control law's memory, a struct of doubles.
template <class Memory>
Memory& memory_as(double* numbers) {
  return *reinterpret_cast<Memory*>(numbers);
}

}  // namespace quadcore::control
