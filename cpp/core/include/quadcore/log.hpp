#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/topics.hpp"
#include "quadcore/state.hpp"

/// \file
/// Content and format of the rows of a log.

namespace quadcore QUADCORE_EXPORT {

/// Return the log columns for n rotors: t, pose, velocities, rotor speeds.
std::vector<std::string> log_columns(std::size_t rotor_count);
/// Return the columns of a topic, which follow: TOPIC.stamp, TOPIC.FIELD and so on.
std::vector<std::string> log_columns(const Topic& topic);
/// Return the comment line on ignored elements, "# ignored: NAME, ...", or "". It follows the
/// column names, because most programs take the first line for the names and skip comments only
/// afterwards.
std::string log_remark(const std::vector<std::string>& ignored);
/// Append the values of the columns; changes nothing if memory runs out.
void append_log_row(const VehicleState& state, std::vector<double>& table);
/// Append the stamp and the values of the last message, or NaN before the first.
void append_log_row(const Topic& topic, std::vector<double>& table);

/// Append a row of numbers as CSV with the fewest digits that restore every bit.
void append_csv(const double* row, std::size_t columns, std::string& text);

}  // namespace quadcore
