#include "quadcore/loads.hpp"

#include <algorithm>

namespace quadcore {

void Loads::clear() {
  frame_ = Wrench{};
  std::fill(rotor_forces_F_.begin(), rotor_forces_F_.end(), Vector3d::Zero());
  std::fill(joint_torques_.begin(), joint_torques_.end(), 0.0);
}

bool Loads::all_finite() const {
  // A sum is finite if its terms are, and they are far from overflow.
  Vector3d sum = frame_.force_F + frame_.torque_F;
  for (const Vector3d& f_F : rotor_forces_F_) sum += f_F;
  for (const double torque : joint_torques_) sum.x() += torque;
  return sum.allFinite();
}

void Loads::record(std::size_t term, const Vector3d& f_F, const Vector3d& p_FQ_F) {
  terms_[term].force_F += f_F;
  terms_[term].torque_F += (p_FQ_F - kinematics_->p_FCcm_F).cross(f_F);
}

}  // namespace quadcore
