#include "quadcore/flight.hpp"

#include <algorithm>

#include "quadcore/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

template <class Vector>
void append(std::vector<double>& to, const Vector& vector) {
  to.insert(to.end(), vector.data(), vector.data() + vector.size());
}

}  // namespace

std::vector<std::string> log_columns(std::size_t rotor_count) {
  std::vector<std::string> columns = {"t",  "x",  "y",  "z",  "qx", "qy", "qz",
                                      "qw", "vx", "vy", "vz", "wx", "wy", "wz"};
  for (std::size_t i = 0; i < rotor_count; ++i) columns.push_back("j" + std::to_string(i + 1));
  return columns;
}

std::string log_remark(const std::vector<std::string>& ignored) {
  if (ignored.empty()) return "";
  std::string names = joined(ignored);
  std::replace_if(names.begin(), names.end(), [](unsigned char c) { return c < 0x20; }, ' ');
  return "\n# ignored: " + names;
}

void append_log_row(const VehicleState& state, std::vector<double>& table) {
  table.push_back(state.time);
  append(table, state.position);
  append(table, state.orientation.coeffs());
  append(table, state.linear_velocity);
  append(table, state.angular_velocity);
  append(table, state.rotor_velocity);
}

Flight::Flight(Simulation& simulation, std::optional<Commands> commands, std::int64_t log_every)
    : simulation_(simulation), commands_(std::move(commands)), log_every_(log_every) {
  if (log_every < 1) {
    throw InputError("log_every is " + std::to_string(log_every) + "; give a whole number >= 1");
  }
  log();
}

void Flight::advance(std::int64_t n) {
  for (; n > 0; --n) {
    if (commands_) {
      const double* speeds = commands_->at(simulation_.time());
      if (speeds) simulation_.command(speeds, simulation_.command_width());
    }
    simulation_.step();
    if (++steps_ % log_every_ == 0) log();
  }
}

void Flight::log() {
  const std::vector<Wrench>& wrenches = simulation_.wrenches();  // may throw: no half a row then
  append_log_row(simulation_.state(), table_);
  for (const Wrench& wrench : wrenches) {
    append(wrenches_, wrench.force_F);
    append(wrenches_, wrench.torque_F);
  }
  ++rows_;
}

}  // namespace quadcore
