#include "log_per_flight.hpp"

#include <filesystem>
#include <utility>

#include "quadcore/text.hpp"

namespace quadcore::node {
namespace {

/// A name beside a file that no other has.
std::filesystem::path free_name(const std::filesystem::path& file) {
  for (int i = 1;; ++i) {
    std::filesystem::path name = file.parent_path() / file.stem();
    name += ".before_" + std::to_string(i) + file.extension().string();
    std::error_code error;
    if (!std::filesystem::exists(std::filesystem::symlink_status(name, error))) return name;
  }
}

}  // namespace

LogPerFlight::LogPerFlight(const std::string& path,
                           std::function<std::unique_ptr<FlightLog>()> open)
    : path_(path), open_(std::move(open)), log_(open_()) {}

void LogPerFlight::add(const Simulation& simulation, bool jumped) {
  // A clock that is followed may be set back without a jump of the motion; times grow in a log.
  if (rows_ > 0 && (jumped || simulation.time() <= time_)) begin_anew();
  if (!log_) return;
  log_->add(simulation);
  if (!log_->error().empty()) fail(log_->error());
  time_ = simulation.time();
  ++rows_;
}

void LogPerFlight::close() {
  if (!log_) return;
  log_->close();
  if (!log_->error().empty()) fail(log_->error());
}

/// A start from which nothing was flown is no flight, and is written anew.
void LogPerFlight::begin_anew() {
  std::error_code error;
  const auto kind = std::filesystem::status(path_, error).type();
  using Kind = std::filesystem::file_type;
  if (kind != Kind::regular && kind != Kind::not_found) return;  // nobody can rename a pipe
  if (rows_ > 1) keep();
  if (!error_.empty()) log_.reset();  // else what was flown would be overwritten
  rows_ = 0;
  if (!log_) return;
  log_.reset();
  try {
    log_ = open_();
  } catch (const std::exception& thrown) {
    fail(thrown.what());
  }
}

void LogPerFlight::keep() {
  close();
  if (!error_.empty()) return;
  const std::string time = seconds(time_);
  std::error_code error;
  if (!std::filesystem::exists(path_, error) && !error) {
    ROS_INFO("%s begins anew; what was flown until t = %s s was moved away or removed",
             path_.c_str(), time.c_str());
    return;
  }
  const std::filesystem::path file = std::filesystem::weakly_canonical(path_, error);
  const std::filesystem::path kept = free_name(file);
  if (!error) std::filesystem::rename(file, kept, error);
  if (error) return fail(path_ + ": cannot be renamed, so the log ends: " + error.message());
  ROS_INFO("what was flown until t = %s s is in %s; the log goes on in %s", time.c_str(),
           kept.c_str(), path_.c_str());
}

void LogPerFlight::fail(const std::string& what) {
  if (error_.empty()) error_ = what;
}

}  // namespace quadcore::node
