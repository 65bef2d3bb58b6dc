#include "command_subscriber.hpp"

#include <algorithm>

#include "quadcore/error.hpp"

namespace quadcore::node {
namespace {

constexpr std::uint32_t queue_of_original = 1000;

}  // namespace

CommandSubscriber::CommandSubscriber(ros::NodeHandle& nh, const std::string& topic, bool lockstep,
                                     FlightThread& flight)
    : flight_(flight) {
  // In lockstep roscpp's queue, which drops in silence, must not be the shorter one.
  const std::uint32_t queue = lockstep ? CommandQueue::most_waiting : queue_of_original;
  // No delay, lest a command waits for the next one.
  subscriber_ = nh.subscribe(topic, queue, &CommandSubscriber::take, this,
                             ros::TransportHints().tcpNoDelay());
}

Refusals CommandSubscriber::refusals() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return refusals_;
}

void CommandSubscriber::take(const ros::MessageEvent<std_msgs::Float64MultiArray const>& event) {
  const std::string& commander = event.getPublisherName();
  if (commander != commander_ && !commander_.empty() && subscriber_.getNumPublishers() > 1) {
    const auto [one, other] = std::minmax(commander, commander_);
    sayer_.warn(subscriber_.getTopic() + ": commands of " + one + " and of " + other +
                " come in turn; end one of them");
  }
  commander_ = commander;
  try {
    flight_.command(event.getConstMessage()->data);
  } catch (const InputError& error) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++refusals_.count;
      refusals_.last = error.what();
    }
    sayer_.warn(subscriber_.getTopic() + ": " + error.what());
  }
}

}  // namespace quadcore::node
