#pragma once

#include "hinged_tree.hpp"

namespace quadcore {

/// All that the steps of one vehicle on hinges read and write. Tables have a column for each rotor,
/// as rotor_layout.hpp says, behind a block in whose columns the frame stands; unused ones are
/// filled with a rotor as well. The equations stand in hinged_bodies.hpp.
struct HingedFlight {
  HingedTree tree;
  std::size_t rotors;
  const std::size_t* joints;  ///< of the rotors, all joints but locked ones
  const double* constants;    ///< table of BodyConstant
  double* state;              ///< table of BodyRow
  double* work;               ///< of each pack of bodies
  double* soft;               ///< the same for rows that give way; null if none does
};

/// Where a vehicle's motion is shown, and the loads on it are: FrameNumber, MotionRow, LoadRow.
struct ShownFlight {
  double *frame, *motion;
};
struct FlightLoads {
  const double *frame_force_F, *frame_torque_F;  ///< about the frame's origin
  const double* rotors;
};

/// \name Steps of a vehicle, W rotors at once; 1 if some hang on others
/// @{
/// Finds how the bodies of a new state stand.
template <int W>
void read_hinged(const HingedFlight& flight);
/// Takes all forces off the bodies.
template <int W>
void clear_hinged(const HingedFlight& flight);
/// Adds loads.
template <int W>
void push_hinged(const HingedFlight& flight, const FlightLoads& loads);
/// Advances by dt [s], with the gyroscopic torque of each body by itself or without. False, and no
/// body has moved, if a hinge asks for a correction beyond the largest.
template <int W>
bool advance_hinged(const HingedFlight& flight, double dt, bool gyroscopic);
template <int W>
void show_hinged(const HingedFlight& flight, const ShownFlight& shown);
/// Finds what the hinges have exerted in the last step.
template <int W>
void find_hinge_loads(const HingedFlight& flight);
/// @}

}  // namespace quadcore
