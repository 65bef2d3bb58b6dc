#pragma once

#include "hinged_tree.hpp"
#include "laws/law_views.hpp"

namespace quadcore {

/// All data that the steps of one vehicle on hinges read and write. Tables have a block of columns
/// for the frame, followed by a column for each rotor in the layout of rotor_layout.hpp. Unused
/// columns also contain a rotor. The equations are in hinged_bodies.hpp.
struct HingedFlight {
  HingedTree tree;
  std::size_t rotors;
  const std::size_t* joints;  ///< joints of the rotors, all except locked ones
  const double* constants;    ///< table of BodyConstant
  double* state;              ///< table of BodyRow
  double* work;               ///< work memory of each pack of bodies
  double* soft;               ///< work memory for compliant rows; null if there are none
};

/// Tables for a vehicle's motion and the loads on it: FrameNumber, MotionRow, LoadRow.
struct ShownFlight {
  double *frame, *motion;
};
struct FlightLoads {
  const double *frame_force_F, *frame_torque_F;  ///< wrench about the frame's origin
  const double* rotors;
};

/// \name Steps of a vehicle in code for lanes of width W, which is 1 if some rotors carry others
/// @{
/// Compute the geometry of a new state.
template <int W>
void read_hinged(const HingedFlight& flight);
/// Set all forces on the bodies to zero.
template <int W>
void clear_hinged(const HingedFlight& flight);
/// Add loads.
template <int W>
void push_hinged(const HingedFlight& flight, const FlightLoads& loads);
/// Set the forces on the bodies to those of force laws in the shown motion, without wind. Returns
/// false if they are not finite.
template <int W>
bool push_hinged_laws(const HingedFlight& flight, const LawViews& views, const ShownFlight& shown);
/// Advance by dt [s], with the gyroscopic torque of each body or without. Returns false without a
/// motion if a hinge requires a correction beyond the maximum.
template <int W>
bool advance_hinged(const HingedFlight& flight, double dt, bool gyroscopic);
template <int W>
void show_hinged(const HingedFlight& flight, const ShownFlight& shown);
/// Compute the loads of the hinges in the last step.
template <int W>
void find_hinge_loads(const HingedFlight& flight);
/// @}

}  // namespace quadcore
