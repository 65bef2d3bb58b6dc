#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/ros.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace quadcore::node {

/// Subscribers that have connected since the last message, with roscpp's callback for each.
class Newcomers final : public ros::CallbackQueueInterface {
 public:
  void addCallback(const ros::CallbackInterfacePtr& greeting, std::uint64_t) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.emplace_back(Clock::now(), greeting);
  }
  void removeByID(std::uint64_t) override { forget(); }

  void forget() {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.clear();
  }

  /// Calls the callbacks of subscribers that have waited for some seconds, each once. A subscriber
  /// that has just connected may be about to send a command.
  void greet() {
    const std::lock_guard<std::mutex> lock(mutex_);
    while (!waiting_.empty() && Clock::now() - waiting_.front().first >= patience) {
      waiting_.front().second->call();
      waiting_.pop_front();
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr auto patience = std::chrono::seconds(3);

  std::mutex mutex_;
  std::deque<std::pair<Clock::time_point, ros::CallbackInterfacePtr>> waiting_;
};

/// Publishes a latched topic with messages that other nodes may answer. An empty publisher has no
/// topic.
template <class Message>
class OfferingPublisher {
 public:
  OfferingPublisher() = default;
  OfferingPublisher(ros::NodeHandle& nh, const std::string& topic, std::uint32_t queue_size)
      : offering_(std::make_shared<Offering>()) {
    const auto greet = [offering =
                            offering_.get()](const ros::SingleSubscriberPublisher& newcomer) {
      newcomer.publish(*offering->offered);
    };
    ros::AdvertiseOptions options;
    options.init<Message>(topic, queue_size, greet);
    options.callback_queue = &offering_->newcomers;
    options.latch = true;
    offering_->publisher = nh.advertise(options);
  }

  void publish(const Message& message) {
    offering_->newcomers.forget();
    offering_->publisher.publish(message);
  }

  /// Sends a message to subscribers that have waited for some seconds, without latching it.
  void offer(const Message& message) {
    offering_->offered = &message;
    offering_->newcomers.greet();
  }

 private:
  struct Offering {
    const Message* offered = nullptr;
    Newcomers newcomers;
    ros::Publisher publisher;
  };

  std::shared_ptr<Offering> offering_;
};

}  // namespace quadcore::node
