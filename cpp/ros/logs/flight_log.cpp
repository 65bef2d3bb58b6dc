#include "flight_log.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "bag_log.hpp"
#include "csv_log.hpp"
#include "log_per_flight.hpp"
#include "mat_log.hpp"
#include "quadcore/log.hpp"

namespace quadcore::node {
namespace {

bool ends_with(const std::string& path, const std::string& end) {
  return path.size() >= end.size() && path.compare(path.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

bool is_log(const std::string& path) {
  for (const char* const end : {".csv", ".mat", ".bag"}) {
    if (ends_with(path, end)) return true;
  }
  std::error_code error;
  return std::filesystem::is_other(path, error);
}

LogRow::LogRow(const Simulation& simulation, const std::vector<std::string>& names)
    : topics_(simulation.topics().at(names)),
      columns_(log_columns(simulation.model().joints.size())) {
  for (const std::size_t topic : topics_) {
    for (std::string& column : log_columns(simulation.topics()[topic]))
      columns_.push_back(std::move(column));
  }
}

std::string LogRow::header() const {
  std::string header;
  for (const std::string& column : columns_) header += (header.empty() ? "" : ",") + column;
  return header;
}

const std::vector<double>& LogRow::fill(const Simulation& simulation) {
  row_.clear();
  append_log_row(simulation.state(), row_);
  for (const std::size_t topic : topics_) append_log_row(simulation.topics()[topic], row_);
  return row_;
}

std::unique_ptr<LogPerFlight> open_log(const std::string& path, const Simulation& simulation,
                                       const std::vector<std::string>& topics, std::int64_t every,
                                       const ros::NodeHandle& nh, const Frames& frames) {
  const bool is_mat = ends_with(path, ".mat"), is_bag = ends_with(path, ".bag");
  const auto open = [=, &simulation, &nh]() -> std::unique_ptr<FlightLog> {
    LogRow row(simulation, topics);
    if (is_mat) return std::make_unique<MatLog>(path, simulation, std::move(row));
    if (is_bag) return std::make_unique<BagLog>(path, simulation, std::move(row), nh, frames);
    return std::make_unique<CsvLog>(path, simulation, std::move(row));
  };
  return std::make_unique<LogPerFlight>(path, every, open);
}

std::string describe_open_failure(const std::string& path) {
  return path + ": cannot be written: " + std::strerror(errno);
}

std::string describe_truncation(const std::string& path) {
  return path + ": the log is incomplete: " + std::strerror(errno);
}

}  // namespace quadcore::node
