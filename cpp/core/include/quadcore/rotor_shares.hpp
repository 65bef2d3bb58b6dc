#pragma once

#include <string>
#include <vector>

#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/topics.hpp"

/// \file
/// Remaining fractions of a rotor quantity after faults.

namespace quadcore {

/// Topic on which controllers read the remaining rotor effectiveness.
constexpr const char* health_topic = "health";

/// Return the message kind with a fraction from 0 to 1 for each rotor: s1, s2 and so on; 1 before
/// the first message.
/// \param of  the quantity that remains
inline MessageKind shares(std::size_t rotors, const std::string& of = "the scaled quantity") {
  MessageKind kind{"shares", {}, std::vector<double>(rotors, 1.0), "remaining fraction of " + of};
  for (std::size_t i = 1; i <= rotors; ++i) kind.fields.push_back("s" + std::to_string(i));
  return kind;
}

/// Throw FlightError for a fraction out of range.
inline void check_shares(const Topic& topic, double time) {
  for (std::size_t j = 0; j < topic.values.size(); ++j) {
    if (topic.values[j] >= 0 && topic.values[j] <= 1) continue;
    throw FlightError(time, "topic '" + topic.name + "': " + topic.kind.fields[j] +
                                " is out of range. Publish a fraction from 0 to 1.");
  }
}

}  // namespace quadcore
