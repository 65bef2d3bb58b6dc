#pragma once

#include <algorithm>
#include <vector>

#include "quadcore/plugin.hpp"
#include "shared/rotor_shares.hpp"

namespace quadcore::aerodynamic {

/// The remaining fractions of the rotors' thrust and reaction torque. They are at the start of the
/// plugin's state, one for each rotor of the vehicle, followed by the number of their message plus
/// one.
class Effectiveness {
 public:
  Effectiveness(const PluginSetup& setup, const std::vector<std::size_t>& rotors)
      : rotors_(rotors),
        whole_(setup.model.joints.size()),
        size_(static_cast<Eigen::Index>(RotorRows<1>::size_of(whole_.rotors()))),
        topic_(setup.topics.takes(setup.parameters.text("effectiveness"), shares(rotors.size()))) {
    for (const std::size_t i : rotors) whole_.number(0, i) = 1;
  }

  /// Return the number of state values.
  Eigen::Index size() const { return size_ + 1; }

  void follow(const Sample& sample, PluginState state) const {
    const Topic& left = sample.topics[topic_];
    if (state[size_] == left.count + 1) return;
    check_shares(left, sample.time);
    state[size_] = left.count + 1;
    for (std::size_t j = 0; j < rotors_.size(); ++j) {
      state[static_cast<Eigen::Index>(rotors_[j])] = left.values[j];
    }
  }

  /// Return the effective fractions, which are 1 until a step begins.
  const double* in_force(ConstPluginState state) const {
    return state[size_] != 0 ? state.data() : whole_.data();
  }

 private:
  std::vector<std::size_t> rotors_;
  RotorRows<1> whole_;
  Eigen::Index size_;  ///< size of the table
  std::size_t topic_;
};

}  // namespace quadcore::aerodynamic
