#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "quadcore/plugin.hpp"

namespace quadcore {

/// The maximum speed of the motors, and the topic with the number of steps in which a command
/// reached it; without a limit there is no topic.
class SpeedLimit {
 public:
  explicit SpeedLimit(const PluginSetup& setup) {
    if (!setup.parameters.has("maxVelocity")) return;
    fastest_ = setup.parameters.number("maxVelocity");
    topic_ = setup.topics.publishes(
        setup.parameters.text("saturation"),
        {"saturation",
         {"steps"},
         {},
         "number of steps so far with a command at the motors' `maxVelocity`"});
  }

  double fastest() const { return fastest_; }
  double clamped(double speed) const { return std::clamp(speed, -fastest_, fastest_); }
  void count(const Sample& sample, const std::vector<double>& command) const {
    if (!topic_) return;  // a command without a finite limit reaches none
    const bool is_reached = std::any_of(command.begin(), command.end(), [this](double speed) {
      return std::abs(speed) >= fastest_;
    });
    if (!is_reached) return;
    const double steps = sample.topics[*topic_].values.front();
    *sample.topics.publish(*topic_, sample.time) = steps + 1;
  }

  /// \name Tags
  /// @{
  static TagSpec limit_tag() {
    return TagSpec::number("maxVelocity", "rad/s", "",
                           "maximum rotor speed; faster commands saturate")
        .above(0)
        .or_absent("none");
  }
  static TagSpec topic_tag() {
    return TagSpec::text(
        "saturation", "saturation",
        "topic, if maxVelocity is set: number of steps so far with a command that reached it");
  }
  /// @}

 private:
  double fastest_ = INFINITY;  ///< rad/s
  std::optional<std::size_t> topic_;
};

}  // namespace quadcore
