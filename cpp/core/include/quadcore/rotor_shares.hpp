#pragma once

#include <string>
#include <vector>

#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/topics.hpp"

/// \file
/// What faults leave of each rotor: a share of something.

namespace quadcore {

/// Topic on which controllers read what is left of the rotors.
constexpr const char* health_topic = "health";

/// The kind of message that holds them for so many rotors: s1, s2 and so on, each from 0 to 1; 1
/// before the first message.
/// \param of  what each rotor has a share of
inline MessageKind shares(std::size_t rotors, const std::string& of = "what the reader scales") {
  MessageKind kind{"shares", {}, std::vector<double>(rotors, 1.0), "share that is left of " + of};
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
