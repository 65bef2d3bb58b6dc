#pragma once

#include <string>
#include <vector>

#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/topics.hpp"

/// \file
/// What faults say of rotors: of each the share that is left of something.

namespace quadcore {

/// Topic on which control laws are told what is left of the rotors.
constexpr const char* health_topic = "health";

/// The kind of message that tells them of so many rotors: s1, s2 and so on, each from 0 to 1; all
/// of each rotor before the first message.
inline MessageKind shares(std::size_t rotors) {
  MessageKind kind{"shares", {}, std::vector<double>(rotors, 1.0)};
  for (std::size_t i = 1; i <= rotors; ++i) kind.fields.push_back("s" + std::to_string(i));
  return kind;
}

/// Throws FlightError on a share that is none.
inline void check_shares(const Topic& topic, double time) {
  for (std::size_t j = 0; j < topic.values.size(); ++j) {
    if (topic.values[j] >= 0 && topic.values[j] <= 1) continue;
    throw FlightError(time, "topic '" + topic.name + "': " + topic.kind.fields[j] +
                                " is out of range; publish a share from 0 to 1");
  }
}

}  // namespace quadcore
