#pragma once

#include <cstddef>

/// \file
/// Where the numbers of the rotors lie, for laws that take several rotors at once. Free of Eigen
/// and of code, so that files compiled for one processor may include it.

namespace quadcore {

/// Most rotors that a law may take at once. Their numbers lie in blocks of so many rotors: first
/// the first quantity of each, then the second, and so on. The last block is filled up with zeros,
/// so that no law has to treat the last rotors apart.
constexpr std::size_t widest_lanes = 8;

/// Where, in tables of so many rows, the first quantity of rotor i lies; the next ones follow at
/// distances of widest_lanes.
constexpr std::size_t rotor_offset(std::size_t rows, std::size_t i) {
  return i / widest_lanes * rows * widest_lanes + i % widest_lanes;
}

/// Where the frame's motion lies in FrameMotion: the first number of each member there, a rotation
/// by columns, a quaternion as x, y, z, w.
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

/// Rows of the rotors' motion, three for a vector, nine (by columns) for a rotation. Vectors are in
/// the frame's axes.
struct MotionRow {
  enum : std::size_t {
    axis = 0,           ///< of the joint, unit
    normal = 3,         ///< z axis of the rotor's link, unit
    p_FRcm = 6,         ///< centre of mass from F's origin [m]
    v_WR = 9,           ///< velocity of the link's origin [m/s]
    v_WRcm = 12,        ///< velocity of the centre of mass [m/s]
    rate = 15,          ///< of the joint [rad/s]
    angle = 16,         ///< of the joint [rad]; only if R_FR is not filled
    R_FR = 17,          ///< orientation of the rotor's link; only if the engine has rotations
    R_FR_at_zero = 26,  ///< the same at joint angle zero
    count = 35          ///< rows
  };
};

/// Rows of the rotors' loads.
struct LoadRow {
  enum : std::size_t {
    force = 0,         ///< on each rotor at its centre of mass [N]
    reaction = 3,      ///< torque of each rotor on the frame [N m]
    joint_torque = 6,  ///< about the joint axis on each rotor, and against it on its parent [N m]
    count = 7          ///< rows
  };
};

/// The tables of one vehicle, laid out as rotor_offset() says.
struct RotorLanes {
  const double* motion;  ///< of MotionRow::count rows
  double* loads;         ///< of LoadRow::count rows, to be added to
  std::size_t rotors;    ///< columns
  bool has_rotations;    ///< whether MotionRow::R_FR is filled, or MotionRow::angle
};

}  // namespace quadcore
