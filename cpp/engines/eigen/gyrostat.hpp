#pragma once

#include "gyrostat_step.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/rotor_rows.hpp"

namespace quadcore {

/// The constants of a gyrostat; cpp/physics/laws/gyrostat.hpp has its equations.
struct Gyrostat {
  double inverse_mass;           ///< 1/kg
  Vector3d p_FCcm_F;             ///< m
  Matrix3d I_Ccm_F;              ///< whole vehicle [kg m^2]
  Matrix3d inverse_reduced_I_F;  ///< inverse of I_C - sum J_i a_i a_i^T
  RotorRows<RotorConstant::count> rotors;
  std::vector<Vector3d> p_FRcm_F;      ///< centre of mass of each rotor [m]
  std::vector<Matrix3d> R_FR_at_zero;  ///< orientation of each rotor's link at angle zero
  bool normals_turn = false;           ///< whether some rotor link's z is off the joint's axis
  bool upright = true;  ///< whether each rotor's axis and its link's z are along the frame's z

  /// Return the inverse of the reduced inertia if some rotors turn with the frame.
  Matrix3d inverse_inertia_with(const std::vector<bool>& rotors_of_frame) const;

  /// Throw InputError with reason and alternative engine if a model is not a gyrostat.
  explicit Gyrostat(const Model& model);
};

/// Return the reach of a vehicle's shapes from its centre of mass in all attitudes [m]; negative
/// without shapes.
double find_reach(const Model& model, const Gyrostat& body);

/// Return the model with the inertia of each rotor averaged over its rotation. An inertia with the
/// axis as a principal axis is then symmetric about it.
/// \param warnings  receives the rotors that were not symmetric
Model with_round_rotors(const Model& model, std::vector<std::string>& warnings);

}  // namespace quadcore
