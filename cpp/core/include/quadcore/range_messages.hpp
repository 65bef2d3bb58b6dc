#pragma once

#include <cstddef>
#include <string>

#include "quadcore/plugin/messages.hpp"

/// \file
/// Messages of sensors that measure distances, which plugins and the ROS node share.

namespace quadcore::messages {

/// Measurement of a range sensor.
struct Range {
  static constexpr const char* kind = "range";  ///< MessageKind::name
  /// MessageKind::meaning
  static constexpr const char* meaning =
      "distance and its limits, m; inf: nothing within the limits, -inf: something below them";
  double range = 0;    ///< distance [m]; infinite if nothing is within the limits
  double minimum = 0;  ///< shortest measured distance [m]
  double maximum = 0;  ///< longest measured distance [m]

  template <class M, class Visit>
  static void for_each_field(M& m, const Visit& visit) {
    visit_number(visit, "range", m.range);
    visit_number(visit, "minimum", m.minimum);
    visit_number(visit, "maximum", m.maximum);
  }
};

/// Number of a scan's fields before its distances.
constexpr std::size_t scan_numbers = 4;

/// Return the kind for the distances along so many beams in a plane.
inline MessageKind scan(std::size_t beams) {
  MessageKind kind{
      "scan",
      {"angle_min", "angle_increment", "range_min", "range_max"},
      {},
      "first angle and angle between beams, rad; limits and distances of the beams, m"};
  for (std::size_t i = 0; i < beams; ++i) kind.fields.push_back("r" + std::to_string(i + 1));
  return kind;
}

}  // namespace quadcore::messages
