#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "configuration.hpp"
#include "quadcore/plugin.hpp"
#include "shared/rotor_shares.hpp"

namespace quadcore::aerodynamic {

/// The coefficients in force: those of the tags, with the rotors' shares of thrust and reaction
/// torque that are left. They lie at the beginning of the plugin's state, behind them the number of
/// the message that they follow, plus one, once a step has begun, and a digest of the tags' own: a
/// state may come from a simulation with other tags.
class Effectiveness {
 public:
  Effectiveness(const PluginSetup& setup, const Config& config)
      : config_(config),
        size_(static_cast<Eigen::Index>(
            RotorRows<CoefficientRow::count>::size_of(setup.model.joints.size()))),
        topic_(setup.topics.takes(setup.parameters.text("effectiveness"),
                                  shares(config.rotors.size()))),
        digest_(digest(config.coefficients.data(), size_)) {}

  /// Numbers of state.
  Eigen::Index size() const { return size_ + 2; }

  void follow(const Sample& sample, PluginState state) const {
    const Topic& left = sample.topics[topic_];
    if (state[size_] == left.count + 1 && state[size_ + 1] == digest_) return;
    check_shares(left, sample.time);
    state[size_] = left.count + 1;
    state[size_ + 1] = digest_;
    std::copy_n(config_.coefficients.data(), size_, state.data());
    for (std::size_t j = 0; j < config_.rotors.size(); ++j) {
      double* rows = state.data() + rotor_offset(CoefficientRow::count, config_.rotors[j]);
      for (const std::size_t row : {CoefficientRow::k, CoefficientRow::b}) {
        rows[row * widest_lanes] *= left.values[j];
      }
    }
  }

  /// Whether the coefficients in the state are in force; those of the tags are otherwise.
  bool has_begun(ConstPluginState state) const {
    return state[size_] != 0 && state[size_ + 1] == digest_;
  }

 private:
  /// A whole number that other coefficients hardly have (FNV-1a over their bits).
  static double digest(const double* coefficients, Eigen::Index count) {
    std::uint64_t hash = 14695981039346656037u;
    for (Eigen::Index i = 0; i < count; ++i) {
      std::uint64_t bits;
      std::memcpy(&bits, coefficients + i, sizeof bits);
      hash = (hash ^ bits) * 1099511628211u;
    }
    return static_cast<double>(hash >> 12);
  }

  const Config& config_;
  Eigen::Index size_;  ///< of the table
  std::size_t topic_;
  double digest_;
};

}  // namespace quadcore::aerodynamic
