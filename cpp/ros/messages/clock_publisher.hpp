#pragma once

#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>

#include <atomic>
#include <memory>

#include "latched_publisher.hpp"
#include "message_rate.hpp"

namespace quadcore::node {

/// Publishes /clock. Copies share the topic; an empty publisher has no topic.
class ClockPublisher {
 public:
  ClockPublisher() = default;
  /// \param rate  messages per second of simulation time; 0 = after each step
  ClockPublisher(ros::NodeHandle& nh, double rate)
      : topic_(nh, "/clock", 1000, Resend::to_all), pace_(std::make_shared<Pace>(rate)) {}

  explicit operator bool() const { return pace_ != nullptr; }

  /// Call after each step; `jumped`: after the start, a reset or a new state.
  void publish(const rosgraph_msgs::Clock& clock, bool jumped) {
    const bool is_due = pace_->due.due(clock.clock.toSec(), jumped);
    if (pace_->each_step || is_due) {
      topic_.publish(clock);
    } else {
      topic_.keep(clock);
    }
  }
  /// Publishes the present time, and from now on each step, because vehicles follow the clock.
  void serve_follower() {
    if (!pace_->each_step.exchange(true)) repeat();
  }
  void repeat() { topic_.repeat(); }
  void shutdown() { topic_.shutdown(); }

 private:
  struct Pace {
    explicit Pace(double rate) : each_step(rate == 0), due(rate) {}
    std::atomic<bool> each_step;
    MessageRate due;  ///< of the flight's thread
  };

  LatchedPublisher<rosgraph_msgs::Clock> topic_;
  std::shared_ptr<Pace> pace_;
};

}  // namespace quadcore::node
