#pragma once

#include <algorithm>
#include <cmath>

#include "quadcore/plugin.hpp"

namespace quadcore::rotors {

/// The position controller of a motor, like Gazebo's class PID, sampled once per step:
///   torque = -p e - clamp(i sum(e dt), iMin, iMax) - d (e - e_last)/dt,
/// where e is the angle minus the wanted angle, between -pi and pi.
class PositionControl {
 public:
  enum Memory { kSum, kLast, kMemorySize };

  explicit PositionControl(const Parameters& p)
      : p_(p.number(name("p"))),
        i_(p.number(name("i"))),
        d_(p.number(name("d"))),
        i_max_(p.number(name("iMax"))),
        i_min_(p.number(name("iMin"))),
        largest_(p.number(name("cmdMax"))),
        smallest_(p.number(name("cmdMin"))) {
    if (i_min_ > i_max_) {
      throw InputError("<iMin> of <joint_control_pid> exceeds <iMax>. Swap them.");
    }
  }

  double torque(double angle, double wanted, double dt, Eigen::Ref<VectorXd> memory) const {
    const double error = std::remainder(
        std::remainder(angle, 2 * M_PI) - std::remainder(wanted, 2 * M_PI), 2 * M_PI);
    memory[kSum] = std::clamp(memory[kSum] + dt * i_ * error, i_min_, i_max_);
    const double torque = -p_ * error - memory[kSum] - d_ * (error - memory[kLast]) / dt;
    memory[kLast] = error;
    return is_bounded() ? std::clamp(torque, smallest_, largest_) : torque;
  }

  /// Return whether the given or default bounds limit the torque to zero.
  bool is_mute() const { return is_bounded() && smallest_ == 0 && largest_ == 0; }

  static void add_tags(std::vector<TagSpec>& tags) {
    const auto add = [&](const char* gain, const char* unit, const std::string& meaning) {
      tags.push_back(TagSpec::number(name(gain), unit, "0", meaning).from("Gazebo's PID"));
    };
    add("p", "N m/rad", "proportional gain, for motorType position");
    add("i", "N m/(rad s)", "integral gain, for motorType position");
    add("d", "N m s/rad", "derivative gain, for motorType position");
    add("iMax", "N m", "maximum integral torque");
    add("iMin", "N m", "minimum integral torque");
    add("cmdMax", "N m", "maximum torque; below cmdMin: no bounds");
    add("cmdMin", "N m", "minimum torque; if both bounds are 0: no torque");
  }

 private:
  /// Gazebo treats reversed bounds as no bounds.
  bool is_bounded() const { return smallest_ <= largest_; }
  static std::string name(const char* gain) { return std::string("joint_control_pid/") + gain; }

  double p_, i_, d_, i_max_, i_min_, largest_, smallest_;
};

}  // namespace quadcore::rotors
