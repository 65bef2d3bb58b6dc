#pragma once

#include <algorithm>

#include "configuration.hpp"
#include "plugins/rotor_shares.hpp"
#include "quadcore/plugin.hpp"

namespace quadcore::aerodynamic {

/// The coefficients in force: those of the tags, with the rotors' shares of thrust and reaction
/// torque that are left. They lie at the beginning of the plugin's state, behind them the number of
/// the message that they follow, plus one, once a step has begun.
class Effectiveness {
 public:
  Effectiveness(const PluginSetup& setup, const Config& config)
      : config_(config),
        size_(static_cast<Eigen::Index>(
            RotorRows<CoefficientRow::count>::size_of(setup.model.joints.size()))),
        topic_(setup.topics.takes(setup.parameters.text("effectiveness"),
                                  shares(config.rotors.size()))) {}

  /// Numbers of state.
  Eigen::Index size() const { return size_ + 1; }

  void follow(const Sample& sample, PluginState state) const {
    const Topic& left = sample.topics[topic_];
    if (state[size_] == left.count + 1) return;
    check_shares(left, sample.time);
    state[size_] = left.count + 1;
    std::copy_n(config_.coefficients.data(), size_, state.data());
    for (std::size_t j = 0; j < config_.rotors.size(); ++j) {
      double* rows = state.data() + rotor_offset(CoefficientRow::count, config_.rotors[j]);
      for (const std::size_t row : {CoefficientRow::k, CoefficientRow::b}) {
        rows[row * widest_lanes] *= share_of(left, j);
      }
    }
  }

  bool has_begun(ConstPluginState state) const { return state[size_] != 0; }

 private:
  const Config& config_;
  Eigen::Index size_;  ///< of the table
  std::size_t topic_;
};

}  // namespace quadcore::aerodynamic
