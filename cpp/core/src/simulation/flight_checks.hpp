#pragma once

#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/state.hpp"

namespace quadcore {

struct Snapshot;

constexpr const char* no_longer_finite = "the state is no longer finite";

bool is_finite(const Kinematics& kinematics);

/// Return whether a motion is within the limits of a flight. NaN is not.
bool is_sane(const Kinematics& kinematics);

/// Throw InputError if a snapshot is damaged or has a plugin state of another size.
void check_snapshot(const Snapshot& snapshot, Eigen::Index plugin_state);

/// Throw InputError if a state is invalid for a vehicle with so many rotors, or so extreme that the
/// next step would end the flight as diverged.
void check_state(const VehicleState& state, Eigen::Index rotors);

/// Throw InputError if a start is not finite, or so far away that a flight counts as diverged.
void check_spawn(const Pose& spawn);

}  // namespace quadcore
