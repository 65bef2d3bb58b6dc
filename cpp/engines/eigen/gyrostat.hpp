#pragma once

#include "gyrostat_step.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/rotor_rows.hpp"

namespace quadcore {

/// The constants of a gyrostat, whose equations stand in cpp/physics/laws/gyrostat.hpp.
struct Gyrostat {
  double inverse_mass;           ///< 1/kg
  Vector3d p_FCcm_F;             ///< m
  Matrix3d I_Ccm_F;              ///< whole vehicle [kg m^2]
  Matrix3d inverse_reduced_I_F;  ///< of I_C - sum J_i a_i a_i^T
  RotorRows<RotorConstant::count> rotors;
  std::vector<Vector3d> p_FRcm_F;      ///< centre of mass of each rotor [m]
  std::vector<Matrix3d> R_FR_at_zero;  ///< orientation of each rotor's link at angle zero
  bool normals_turn = false;           ///< some rotor's link has its z off the joint's axis
  bool upright = true;  ///< each rotor's axis and its link's z lie along the frame's z

  /// The inverse of the reduced inertia if some rotors turned with the frame.
  Matrix3d inverse_inertia_with(const std::vector<bool>& rotors_of_frame) const;

  /// Throws InputError on a model that is no gyrostat: why, and which engine to use instead.
  explicit Gyrostat(const Model& model);
};

/// The model with the inertia of each rotor averaged over its turns. Such as has its axis for a
/// principal one is then symmetric about it.
/// \param warnings  are told which rotors were not
Model with_round_rotors(const Model& model, std::vector<std::string>& warnings);

}  // namespace quadcore
