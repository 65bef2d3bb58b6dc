#include "quadcore/loads.hpp"

#include <algorithm>
#include <string>

#include "quadcore/error.hpp"

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

void Loads::refuse_rotor(std::size_t i) const {
  throw Error("a load on rotor " + std::to_string(i) + ", but rotors count from 0 and there are " +
              std::to_string(joint_torques_.size()));
}

Wrench& Loads::recorded(std::size_t term) {
  if (term >= term_count_) {
    throw Error("a load for wrench term " + std::to_string(term) +
                ", but terms count from 0 and the descriptor names " + std::to_string(term_count_));
  }
  return terms_[term];
}

void Loads::record(std::size_t term, const Vector3d& f_F, const Vector3d& p_FQ_F) {
  Wrench& wrench = recorded(term);
  wrench.force_F += f_F;
  wrench.torque_F += (p_FQ_F - kinematics_->p_FCcm_F).cross(f_F);
}

}  // namespace quadcore
