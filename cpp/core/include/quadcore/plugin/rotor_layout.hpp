#pragma once

#include <cstddef>

/// \file
/// Memory layout of the rotors' numbers, for force laws on several rotors at once. Contains neither
/// Eigen nor code, so that files compiled for a specific processor can include it.

namespace quadcore {

/// Maximum number of rotors that a force law processes at once. The numbers are stored in blocks of
/// so many rotors: the first quantity of each rotor, then the second, and so on. Zeros fill the
/// last block, so no law needs to treat the last rotors separately.
constexpr std::size_t widest_lanes = 8;

/// Return the offset of rotor i's first quantity in a table of so many rows. The next ones follow
/// at distances of widest_lanes.
constexpr std::size_t rotor_offset(std::size_t rows, std::size_t i) {
  return i / widest_lanes * rows * widest_lanes + i % widest_lanes;
}

/// Offset of each member of FrameMotion. Rotations are stored by columns, quaternions as x, y, z,
/// w.
struct FrameNumber {
  enum : std::size_t {
    p_WF = 0,
    time = 3,
    q_WF = 4,
    R_WF = 8,
    v_WF_F = 17,
    w_WF_F = 20,
    p_FCcm_F = 23,
    v_WCcm_F = 26,
    v_WA_F = 29
  };
};

/// Rows of the rotors' motion: three for a vector, nine (by columns) for a rotation. Vectors are in
/// the frame's axes.
struct MotionRow {
  enum : std::size_t {
    axis = 0,           ///< axis of the joint, unit
    normal = 3,         ///< z axis of the rotor's link, unit
    p_FRcm = 6,         ///< centre of mass from F's origin [m]
    v_WR = 9,           ///< velocity of the link's origin [m/s]
    v_WRcm = 12,        ///< velocity of the centre of mass [m/s]
    rate = 15,          ///< rate of the joint [rad/s]
    angle = 16,         ///< angle of the joint [rad]; only if R_FR is not filled
    R_FR = 17,          ///< orientation of the rotor's link; only if the engine provides rotations
    R_FR_at_zero = 26,  ///< orientation of the rotor's link at joint angle zero
    count = 35          ///< rows
  };
};

/// Rows of the rotors' loads.
struct LoadRow {
  enum : std::size_t {
    force = 0,         ///< force on each rotor at its centre of mass [N]
    reaction = 3,      ///< torque of each rotor on the frame [N m]
    joint_torque = 6,  ///< about the joint axis on each rotor, opposite on its parent [N m]
    count = 7          ///< rows
  };
};

/// The tables of one vehicle, in the layout of rotor_offset().
struct RotorLanes {
  const double* motion;  ///< table of MotionRow::count rows
  double* loads;         ///< table of LoadRow::count rows, to which laws add
  std::size_t rotors;    ///< number of columns
  bool has_rotations;    ///< whether MotionRow::R_FR is filled instead of MotionRow::angle
};

}  // namespace quadcore
