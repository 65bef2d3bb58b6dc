#include "quadcore/log.hpp"

#include <algorithm>
#include <cmath>

#include "quadcore/text.hpp"

namespace quadcore {
namespace {

constexpr std::size_t fixed_columns = 14;

}  // namespace

std::vector<std::string> log_columns(std::size_t rotor_count) {
  std::vector<std::string> columns = {"t",  "x",  "y",  "z",  "qx", "qy", "qz",
                                      "qw", "vx", "vy", "vz", "wx", "wy", "wz"};
  for (std::size_t i = 0; i < rotor_count; ++i) columns.push_back("j" + std::to_string(i + 1));
  return columns;
}

std::vector<std::string> log_columns(const Topic& topic) {
  std::vector<std::string> columns = {topic.name + ".stamp"};
  for (const std::string& field : topic.kind.fields) columns.push_back(topic.name + "." + field);
  return columns;
}

std::string log_remark(const std::vector<std::string>& ignored) {
  if (ignored.empty()) return "";
  std::string names = joined(ignored);
  std::replace_if(names.begin(), names.end(), [](unsigned char c) { return c < 0x20; }, ' ');
  return "\n# ignored: " + names;
}

void append_log_row(const VehicleState& state, std::vector<double>& table) {
  const std::size_t before = table.size();
  table.resize(before + fixed_columns + static_cast<std::size_t>(state.rotor_velocity.size()));
  double* to = table.data() + before;
  const auto append = [&to](const auto& vector) {
    to = std::copy_n(vector.data(), vector.size(), to);
  };
  *to++ = state.time;
  append(state.position);
  append(state.orientation.coeffs());
  append(state.linear_velocity);
  append(state.angular_velocity);
  append(state.rotor_velocity);
}

void append_log_row(const Topic& topic, std::vector<double>& table) {
  if (topic.count == 0) {
    table.insert(table.end(), 1 + topic.values.size(), std::nan(""));
    return;
  }
  table.push_back(topic.stamp);
  table.insert(table.end(), topic.values.begin(), topic.values.end());
}

void append_csv(const double* row, std::size_t columns, std::string& text) {
  for (std::size_t i = 0; i < columns; ++i) {
    if (i > 0) text += ',';
    append_shortest(row[i], text);
  }
  text += '\n';
}

}  // namespace quadcore
