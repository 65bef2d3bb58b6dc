#include "command_subscriber.hpp"

#include <mav_msgs/Actuators.h>
#include <std_msgs/Float64MultiArray.h>

#include <algorithm>

#include "messages.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::node {
namespace {

const std::vector<double>& get_speeds(const std_msgs::Float64MultiArray& message) {
  return message.data;
}
const std::vector<double>& get_speeds(const mav_msgs::Actuators& message) {
  return message.angular_velocities;
}

template <class Message, class Take>
ros::Subscriber subscribe(ros::NodeHandle& nh, const std::string& topic, CallerQueue& queue,
                          const Take& take) {
  using Event = ros::MessageEvent<Message const>;
  const boost::function<void(const Event&)> callback = [take](const Event& event) {
    take(event.getPublisherName(), get_speeds(*event.getConstMessage()));
  };
  ros::SubscribeOptions options;
  options.template initByFullCallbackType<const Event&>(topic, queue_size, callback);
  options.callback_queue = &queue;
  // Without delay, so that a command does not wait for the next one.
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  return nh.subscribe(options);
}

}  // namespace

CommandSubscriber::CommandSubscriber(ros::NodeHandle& nh, const std::vector<CommandTopic>& topics,
                                     FlightThread& flight)
    : flight_(flight), topics_(topics) {
  for (const CommandTopic& topic : topics_) {
    const auto take_from = [this, &topic](const std::string& who, const std::vector<double>& w) {
      take(topic, who, w);
    };
    subscribers_.push_back(
        topic.actuators
            ? subscribe<mav_msgs::Actuators>(nh, topic.name, queue_, take_from)
            : subscribe<std_msgs::Float64MultiArray>(nh, topic.name, queue_, take_from));
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
