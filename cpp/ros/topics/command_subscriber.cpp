#include "command_subscriber.hpp"

#include <mav_msgs/Actuators.h>
#include <std_msgs/Float64MultiArray.h>

#include <algorithm>

#include "quadcore/plugin/error.hpp"

namespace quadcore::node {
namespace {

constexpr std::uint32_t queue_of_original = 1000;

const std::vector<double>& get_speeds(const std_msgs::Float64MultiArray& message) {
  return message.data;
}
const std::vector<double>& get_speeds(const mav_msgs::Actuators& message) {
  return message.angular_velocities;
}

template <class Message, class Take>
ros::Subscriber subscribe(ros::NodeHandle& nh, const std::string& topic, std::uint32_t queue,
                          const Take& take) {
  const boost::function<void(const ros::MessageEvent<Message const>&)> callback =
      [take](const ros::MessageEvent<Message const>& event) {
        take(event.getPublisherName(), get_speeds(*event.getConstMessage()));
      };
  // Without delay, so that a command does not wait for the next one.
  return nh.subscribe<Message>(topic, queue, callback, ros::VoidConstPtr(),
                               ros::TransportHints().tcpNoDelay());
}

}  // namespace

CommandSubscriber::CommandSubscriber(ros::NodeHandle& nh, const std::vector<CommandTopic>& topics,
                                     bool lockstep, FlightThread& flight)
    : flight_(flight), topics_(topics) {
  // In lockstep, roscpp's queue, which drops messages without a warning, must not be shorter.
  const std::uint32_t queue = lockstep ? CommandQueue::max_waiting : queue_of_original;
  for (const CommandTopic& topic : topics_) {
    const auto take_from = [this, &topic](const std::string& who, const std::vector<double>& w) {
      take(topic, who, w);
    };
    subscribers_.push_back(
        topic.actuators ? subscribe<mav_msgs::Actuators>(nh, topic.name, queue, take_from)
                        : subscribe<std_msgs::Float64MultiArray>(nh, topic.name, queue, take_from));
  }
}

Refusals CommandSubscriber::refusals() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return refusals_;
}

void CommandSubscriber::take(const CommandTopic& topic, const std::string& commander,
                             const std::vector<double>& speeds) {
  if (commander == ros::this_node::getName()) return;  // forwarded by a plugin
  if (commander != commander_ && !commander_.empty() && count_commanders(topics_) > 1) {
    const auto [one, other] = std::minmax(commander, commander_);
    limiter_.warn(topic.name + ": both " + one + " and " + other +
                  " send commands. End one of them.");
  }
  commander_ = commander;
  try {
    flight_.command({topic.simulated, speeds});
  } catch (const InputError& error) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++refusals_.count;
      refusals_.last = error.what();
    }
    limiter_.warn(topic.name + ": " + error.what());
  }
}

}  // namespace quadcore::node
