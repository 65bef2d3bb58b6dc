#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/topics.hpp"
#include "quadcore/state.hpp"

/// \file
/// What the rows of a log hold, and how they are written.

namespace quadcore QUADCORE_EXPORT {

/// Names of the log columns for n rotors: t, pose, velocities, rotor speeds.
std::vector<std::string> log_columns(std::size_t rotor_count);
/// Names of the columns of a topic, which follow those: TOPIC.stamp, TOPIC.FIELD and so on.
std::vector<std::string> log_columns(const Topic& topic);
/// What follows the names in a CSV log: "" or, on a line of its own, "# ignored: NAME, ...". Below
/// them, because most programs take the first line for the names and skip comments afterwards.
std::string log_remark(const std::vector<std::string>& ignored);
/// Appends what stands in them; without memory nothing.
void append_log_row(const VehicleState& state, std::vector<double>& table);
/// Appends the last message's stamp and numbers, NaN before the first.
void append_log_row(const Topic& topic, std::vector<double>& table);

/// Appends a row of numbers as CSV with the fewest digits that restore every bit.
void append_csv(const double* row, std::size_t columns, std::string& text);

}  // namespace quadcore
