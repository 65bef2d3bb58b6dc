#include "listener.hpp"

#include <algorithm>
#include <utility>

#include "quadcore/text.hpp"

namespace quadcore::node {

Listener::Listener(Broadcast& broadcast, TopicInlets& inlets, GazeboWrenches& wrenches,
                   MeanWind& wind, const Simulation& simulation,
                   std::vector<CommandTopic> command_topics, std::unique_ptr<LogPerFlight> log,
                   ClockFollower* follower)
    : broadcast_(broadcast),
      inlets_(inlets),
      wrenches_(wrenches),
      wind_(wind),
      command_topics_(std::move(command_topics)),
      log_(std::move(log)),
      follower_(follower),
      warnings_shown_(simulation.warnings().size()) {}

void Listener::observe(const Simulation& simulation, bool jumped) {
  if (log_) log_->add(simulation, jumped);
  if (log_ && !log_->error().empty()) ROS_ERROR_ONCE("%s", log_->error().c_str());
  wind_.note(simulation);
  broadcast_.send(simulation, jumped);
  if (follower_) follower_->reached(simulation.time());
  // Warnings may appear during a flight; a reset removes them.
  warnings_shown_ = std::min(warnings_shown_, simulation.warnings().size());
  for (; warnings_shown_ < simulation.warnings().size(); ++warnings_shown_) {
    ROS_WARN("%s", simulation.warnings()[warnings_shown_].c_str());
  }
}

void Listener::remind(const Simulation& simulation) {
  limiter_.warn("lockstep: no node publishes on " + join_names(command_topics_) + ". The flight " +
                "waits at t = " + seconds(simulation.time()) +
                ". Start the controller, or run without lockstep.");
  broadcast_.offer(simulation);
}

bool Listener::has_commander() const { return count_commanders(command_topics_) > 0; }

std::string Listener::close_log() {
  if (!log_) return "";
  log_->close();
  return log_->error();
}

}  // namespace quadcore::node
