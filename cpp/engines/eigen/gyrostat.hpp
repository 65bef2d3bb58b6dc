#pragma once

#include <vector>

#include "quadcore/model.hpp"
#include "quadcore/spatial.hpp"

namespace quadcore {

/// A rigid body with n axisymmetric rotors on continuous joints, in reduced coordinates. Because
/// each rotor's centre of mass lies on its axis and its inertia is symmetric about it, the mass
/// distribution does not change as the rotors turn. Notation: C the vehicle's centre of mass, w the
/// frame's rate, W_i the rate of joint i, a_i its axis, J_i the rotor's moment about it.
///
/// Angular momentum about C (e.g. Hughes, "Spacecraft Attitude Dynamics", ch. 6):
///   H = I_C w + sum J_i W_i a_i,   dH/dt + w x H = tau,
/// and of each rotor about its axis, q_i the torque of its joint:
///   J_i (dW_i/dt + a_i . dw/dt) = q_i.
/// Eliminating dW_i/dt leaves (I_C - sum J_i a_i a_i^T) dw/dt = tau - w x H - sum q_i a_i.
struct Gyrostat {
  struct Rotor {
    Vector3d axis_F;    ///< a_i, unit
    Vector3d p_FR_F;    ///< origin of the rotor's link [m]
    Vector3d p_FRcm_F;  ///< its centre of mass [m]
    Matrix3d R_FR;      ///< orientation of its link at angle zero
    bool centered;      ///< origin and centre of mass coincide
    double moment;      ///< J_i [kg m^2]
    double inverse_moment;
    Vector3d moment_axis_F;  ///< J_i a_i
    double damping;          ///< N m s/rad
  };

  double inverse_mass;           ///< 1/kg
  Vector3d p_FCcm_F;             ///< m
  Matrix3d I_Ccm_F;              ///< whole vehicle [kg m^2]
  Matrix3d inverse_reduced_I_F;  ///< of I_C - sum J_i a_i a_i^T
  std::vector<Rotor> rotors;

  /// Throws InputError on a model that is no gyrostat: why, and which engine to use instead.
  explicit Gyrostat(const Model& model);
};

}  // namespace quadcore
