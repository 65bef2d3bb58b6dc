#pragma once

#include <algorithm>
#include <vector>

#include "quadcore/plugin.hpp"
#include "shared/rotor_shares.hpp"

namespace quadcore::aerodynamic {

/// The rotors' shares of thrust and reaction torque that are left. They lie at the beginning of the
/// plugin's state, a number for each rotor of the vehicle, and behind them the number of the
/// message that they follow, plus one.
class Effectiveness {
 public:
  Effectiveness(const PluginSetup& setup, const std::vector<std::size_t>& rotors)
      : rotors_(rotors),
        whole_(setup.model.joints.size()),
        size_(static_cast<Eigen::Index>(RotorRows<1>::size_of(whole_.rotors()))),
        topic_(setup.topics.takes(setup.parameters.text("effectiveness"), shares(rotors.size()))) {
    for (const std::size_t i : rotors) whole_.number(0, i) = 1;
  }

  /// Numbers of state.
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

  /// The shares in force: all of each rotor until a step begins.
  const double* in_force(ConstPluginState state) const {
    return state[size_] != 0 ? state.data() : whole_.data();
  }

 private:
  std::vector<std::size_t> rotors_;
  RotorRows<1> whole_;
  Eigen::Index size_;  ///< of the table
  std::size_t topic_;
};

}  // namespace quadcore::aerodynamic
