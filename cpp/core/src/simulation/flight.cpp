#include "quadcore/flight.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "quadcore/log.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore {
namespace {

/// Reserve room for more values, at least doubling the capacity so that short pieces do not copy
/// all.
void reserve_more(std::vector<double>& numbers, std::size_t more) {
  const std::size_t needed = numbers.size() + more;
  if (needed > numbers.capacity()) numbers.reserve(std::max(needed, 2 * numbers.capacity()));
}

}  // namespace

Flight::Flight(Simulation& simulation, std::optional<Commands> commands, std::int64_t log_every,
               bool wrenches, const std::vector<std::string>& topics, std::size_t to_fill)
    : simulation_(simulation),
      commands_(std::move(commands)),
      log_every_(log_every),
      log_wrenches_(wrenches),
      topics_(simulation.topics().at(topics)),
      to_fill_(to_fill) {
  if (log_every < 1) {
    throw InputError("log_every is " + std::to_string(log_every) + ". Give a whole number >= 1.");
  }
  log();
  row_size_ = rows_.table.size();
  wrenches_size_ = rows_.wrenches.size();
}

void Flight::make_room(std::int64_t n) {
  const auto rows = static_cast<std::size_t>(std::max<std::int64_t>(n, 0) / log_every_ + 1);
  reserve_more(rows_.table, rows * row_size_);
  reserve_more(rows_.wrenches, rows * wrenches_size_);
}

void Flight::advance(std::int64_t n, TotalVariation* rates) {
  while (n > 0) {
    const std::int64_t steps = prepare(n);
    simulation_.step(steps, rates);
    finish(steps);
    n -= steps;
  }
}

std::int64_t Flight::prepare(std::int64_t n) {
  if (!commands_) return std::min(n, steps_to_row_);
  const double* speeds = commands_->at(simulation_.time());
  if (speeds) simulation_.command(speeds, simulation_.command_width());
  return 1;
}

void Flight::finish(std::int64_t steps) {
  steps_to_row_ -= steps;
  if (steps_to_row_ > 0) return;
  steps_to_row_ = log_every_;
  log();
}

LogRows Flight::take() { return std::exchange(rows_, LogRows()); }

void Flight::log() {
  const std::size_t before = rows_.wrenches.size(), row = rows_.table.size();
  if (log_wrenches_) {
    for (const Wrench& wrench : simulation_.wrenches()) {
      for (const Vector3d& part : {wrench.force_F, wrench.torque_F}) {
        rows_.wrenches.insert(rows_.wrenches.end(), part.data(), part.data() + 3);
      }
    }
  }
  try {
    append_log_row(simulation_.motion(), rows_.table);
    for (const std::size_t topic : topics_)
      append_log_row(simulation_.topics()[topic], rows_.table);
    rows_.table.insert(rows_.table.end(), to_fill_, std::numeric_limits<double>::quiet_NaN());
  } catch (...) {
    rows_.wrenches.resize(before);  // drop an incomplete row
    rows_.table.resize(row);
    throw;
  }
  ++rows_.count;
}

}  // namespace quadcore
