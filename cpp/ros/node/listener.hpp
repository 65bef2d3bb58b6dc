#pragma once

#include <memory>
#include <string>
#include <vector>

#include "broadcast.hpp"
#include "clock.hpp"
#include "command_topics.hpp"
#include "flight_thread.hpp"
#include "gazebo_wrenches.hpp"
#include "log_per_flight.hpp"
#include "mean_wind.hpp"
#include "topic_inlets.hpp"
#include "warning_limiter.hpp"

namespace quadcore::node {

/// Publishes a flight, logs it if requested, and passes on warnings.
class Listener final : public FlightListener {
 public:
  /// \param log       log to write; null = no log
  /// \param follower  gets each step; null = this node leads the clock
  Listener(Broadcast& broadcast, TopicInlets& inlets, GazeboWrenches& wrenches, MeanWind& wind,
           const Simulation& simulation, std::vector<CommandTopic> command_topics,
           std::unique_ptr<LogPerFlight> log, ClockFollower* follower);

  void feed(Simulation& simulation) override {
    inlets_.take(simulation);
    wrenches_.act(simulation);
  }
  bool waits_to_feed() const override { return inlets_.waits(); }
  void observe(const Simulation& simulation, bool jumped) override;
  void show(const Simulation& simulation) override { broadcast_.show(simulation); }
  void remind(const Simulation& simulation) override;
  void repeat(const Simulation& simulation) override { broadcast_.send(simulation, true); }
  void warn(const std::string& what) override { limiter_.warn(what); }
  bool has_commander() const override;
  /// Call after the flight has ended. Returns the error of the log; "" = no error.
  std::string close_log();

 private:
  Broadcast& broadcast_;
  TopicInlets& inlets_;
  GazeboWrenches& wrenches_;
  MeanWind& wind_;
  const std::vector<CommandTopic> command_topics_;
  const std::unique_ptr<LogPerFlight> log_;
  ClockFollower* const follower_;
  std::size_t warnings_shown_;  ///< number of warnings already shown
  WarningLimiter limiter_;
};

}  // namespace quadcore::node
