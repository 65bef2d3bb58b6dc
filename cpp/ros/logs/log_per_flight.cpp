#include "log_per_flight.hpp"

#include <filesystem>
#include <utility>

#include "quadcore/text.hpp"

namespace quadcore::node {
namespace {

/// Returns an unused name in the same folder.
std::filesystem::path find_free_name(const std::filesystem::path& file) {
  for (int i = 1;; ++i) {
    std::filesystem::path name = file.parent_path() / file.stem();
    name += ".before_" + std::to_string(i) + file.extension().string();
    std::error_code error;
    if (!std::filesystem::exists(std::filesystem::symlink_status(name, error))) return name;
  }
}

}  // namespace

LogPerFlight::LogPerFlight(const std::string& path, std::int64_t every,
                           std::function<std::unique_ptr<FlightLog>()> open)
    : path_(path), every_(every), open_(std::move(open)), log_(open_()) {}

void LogPerFlight::add(const Simulation& simulation, bool jumped) {
  // A followed clock may be set back without a jump of the motion, but times increase in a log.
  if (states_ > 0 && (jumped || simulation.time() <= time_)) start_new_file();
  if (!log_) return;
  if (states_ % every_ == 0) log_->add(simulation);
  if (!log_->error().empty()) fail(log_->error());
  time_ = simulation.time();
  ++states_;
}

void LogPerFlight::close() {
  if (!log_) return;
  log_->close();
  if (!log_->error().empty()) fail(log_->error());
}

/// Starts a new file. A start without any step is not kept.
void LogPerFlight::start_new_file() {
  std::error_code error;
  const auto kind = std::filesystem::status(path_, error).type();
  using Kind = std::filesystem::file_type;
  if (kind != Kind::regular && kind != Kind::not_found) return;  // a pipe cannot be renamed
  if (states_ > 1) keep_previous();
  if (!error_.empty()) log_.reset();  // otherwise the previous log would be overwritten
  states_ = 0;
  if (!log_) return;
  log_.reset();
  try {
    log_ = open_();
  } catch (const std::exception& thrown) {
    fail(thrown.what());
  }
}

void LogPerFlight::keep_previous() {
  close();
  if (!error_.empty()) return;
  const std::string time = seconds(time_);
  std::error_code error;
  if (!std::filesystem::exists(path_, error) && !error) {
    ROS_INFO("%s starts again; the log until t = %s was moved or removed", path_.c_str(),
             time.c_str());
    return;
  }
  const std::filesystem::path file = std::filesystem::weakly_canonical(path_, error);
  const std::filesystem::path kept = find_free_name(file);
  if (!error) std::filesystem::rename(file, kept, error);
  if (error) return fail(path_ + ": cannot be renamed, and the log ends: " + error.message());
  ROS_INFO("the log until t = %s is in %s; the next one is in %s", time.c_str(), kept.c_str(),
           path_.c_str());
}

void LogPerFlight::fail(const std::string& what) {
  if (error_.empty()) error_ = what;
}

}  // namespace quadcore::node
