#pragma once

#include "air_force.hpp"
#include "quadcore/plugin/rotor_layout.hpp"

/// \file
/// Flat states of one vehicle for several references at once. Contains neither Eigen nor code, so
/// that files compiled for a specific processor can include it.

namespace quadcore::control {

/// Rows of a table with a column of each reference: its derivatives and its yaw, then its flat
/// state, see flat_state(). Matrices are stored by columns.
struct FlatRow {
  enum : std::size_t {
    velocity = 0,
    acceleration = velocity + 3,
    jerk = acceleration + 3,
    snap = jerk + 3,
    sine = snap + 3,  ///< of the yaw
    cosine,
    yaw_rate,
    yaw_acceleration,
    R_WF,
    w_WF_F = R_WF + 9,
    dw_WF_F = w_WF_F + 3,
    w_WF_W = dw_WF_F + 3,
    dw_WF_W = w_WF_W + 3,
    a_FCcm_W = dw_WF_W + 3,
    thrust = a_FCcm_W + 3,
    count
  };
};

/// The parts of ModelledVehicle that flat states depend on.
struct FlatVehicle {
  double mass, gravity;
  bool with_drag;
  double mean_drag;  ///< along x and y of F [N s/m]
  AirNumbers<double> air;
  bool is_offset;  ///< whether the centre of mass differs from the origin of F
  double p_FCcm_F[3];
};

/// Compute the flat states of the first `columns` columns, W at once. The other columns of the last
/// pack are computed as well. Undefined attitudes are not finite.
template <int W>
void solve_flat_states(const FlatVehicle& vehicle, double* table, std::size_t columns);

}  // namespace quadcore::control
