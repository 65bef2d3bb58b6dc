#include "quadcore/plugin/loads.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "quadcore/plugin/error.hpp"

namespace quadcore {

Wrench Loads::frame() const {
  Vector3d reaction_F = Vector3d::Zero();
  for (std::size_t i = 0; i < rotors_.rotors(); ++i)
    reaction_F += rotors_.vector(LoadRow::reaction, i);
  return {frame_.force_F, frame_.torque_F + reaction_F};
}

void Loads::clear() {
  clear_rest();
  rotors_.clear();
}

void Loads::clear_rest() {
  frame_ = Wrench{};
  if (any_rate_) std::fill(rates_.begin(), rates_.end(), std::nullopt);
  any_rate_ = false;
}

bool Loads::all_finite() const {
  // The sum is finite if its terms are, because they are far from overflow.
  double sum = (frame_.force_F + frame_.torque_F).sum();
  for (std::size_t i = 0; i < rotors_.rotors(); i += widest_lanes) {
    const double* const block = rotors_.data() + rotor_offset(LoadRow::count, i);
    const std::size_t lanes = std::min(rotors_.rotors() - i, widest_lanes);
    for (std::size_t j = 0; j < lanes; ++j) {
      double of_rotor = 0;  // apart, so that the rotors' additions do not wait for each other
      for (std::size_t row = 0; row < LoadRow::count; ++row)
        of_rotor += block[row * widest_lanes + j];
      sum += of_rotor;
    }
  }
  for (const auto& rate : rates_) {
    if (rate) sum += rate->at_end + rate->slope;
  }
  return std::isfinite(sum);
}

void Loads::refuse_rotor(std::size_t i) const {
  throw Error("a load acts on rotor " + std::to_string(i) +
              ", but rotors are numbered from 0 and there are " + std::to_string(rotors_.rotors()));
}

void Loads::refuse_second_rate(std::size_t i) const {
  throw Error("the rate of joint " + std::to_string(i) +
              ", counted from 0, is prescribed twice. Let only one plugin drive each joint.");
}

Wrench& Loads::recorded(std::size_t term) {
  if (term >= term_count_) {
    throw Error("a load refers to wrench term " + std::to_string(term) +
                ", but terms are numbered from 0 and the descriptor lists " +
                std::to_string(term_count_));
  }
  return terms_[term];
}

void Loads::record(std::size_t term, const Vector3d& f_F, const Vector3d& p_FQ_F) {
  Wrench& wrench = recorded(term);
  wrench.force_F += f_F;
  wrench.torque_F += (p_FQ_F - kinematics_->p_FCcm_F).cross(f_F);
}

}  // namespace quadcore
