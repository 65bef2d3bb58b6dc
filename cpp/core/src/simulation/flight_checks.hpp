#pragma once

#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/state.hpp"

namespace quadcore {

struct Snapshot;

constexpr const char* no_longer_finite = "the state is no longer finite";

bool is_finite(const Kinematics& kinematics);

/// Whether a motion is one that a flight may mean; NaN is none.
bool is_sane(const Kinematics& kinematics);

/// Throws InputError on a snapshot that none can have taken whose plugins have a state of so many
/// numbers.
void check_snapshot(const Snapshot& snapshot, Eigen::Index plugin_state);

/// Throws InputError on a state that no vehicle of so many rotors can be in, or from which the next
/// step would end the flight as diverged.
void check_state(const VehicleState& state, Eigen::Index rotors);

/// Throws InputError on a start that is not finite, or so far away that a flight counts as
/// diverged.
void check_spawn(const Pose& spawn);

}  // namespace quadcore
