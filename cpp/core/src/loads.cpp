#include "quadcore/loads.hpp"

#include <cmath>
#include <string>

#include "quadcore/error.hpp"

namespace quadcore {

Wrench Loads::frame() const {
  Vector3d reaction_F = Vector3d::Zero();
  for (std::size_t i = 0; i < rotors_.rotors(); ++i)
    reaction_F += rotors_.vector(LoadRow::reaction, i);
  return {frame_.force_F, frame_.torque_F + reaction_F};
}

void Loads::clear() {
  frame_ = Wrench{};
  rotors_.clear();
}

bool Loads::all_finite() const {
  // A sum is finite if its terms are, and they are far from overflow.
  double sum = (frame_.force_F + frame_.torque_F).sum();
  for (std::size_t row = 0; row < LoadRow::count; ++row) {
    for (std::size_t i = 0; i < rotors_.rotors(); ++i) sum += rotors_.number(row, i);
  }
  return std::isfinite(sum);
}

void Loads::refuse_rotor(std::size_t i) const {
  throw Error("a load on rotor " + std::to_string(i) + ", but rotors count from 0 and there are " +
              std::to_string(rotors_.rotors()));
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
