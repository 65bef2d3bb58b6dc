#include "topic_inlets.hpp"

#include <ros/poll_manager.h>

#include <algorithm>
#include <chrono>

#include "quadcore/plugin/error.hpp"

namespace quadcore::node {

TopicInlets::TopicInlets(ros::NodeHandle nh, const Simulation& simulation,
                         const std::vector<std::string>& but, bool lockstep)
    : lockstep_(lockstep) {
  nh.setCallbackQueue(&queue_);
  const Topics& topics = simulation.topics();
  for (const std::string& name : topics.names()) {
    const Topic& topic = topics[topics.at(name)];
    const bool taken = std::find(but.begin(), but.end(), name) != but.end();
    if (taken || topic.writer != the_caller) continue;
    subscribers_.push_back(make_inlet(nh, topic, [this, name](const std::vector<double>& values) {
      try {
        simulation_->publish(name, values.data(), values.size());
      } catch (const InputError& error) {
        limiter_.warn(error.what());
      }
    }));
  }
  if (subscribers_.empty() || !lockstep_) return;
  poll_ = ros::PollManager::instance()->addPollThreadListener([this] {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++turns_;
    reader_ = std::this_thread::get_id();
    turned_.notify_all();
  });
}

TopicInlets::~TopicInlets() { ros::PollManager::instance()->removePollThreadListener(poll_); }

bool TopicInlets::waits() const {
  return lockstep_ &&
         std::any_of(subscribers_.begin(), subscribers_.end(),
                     [](const ros::Subscriber& s) { return s.getNumPublishers() > 0; });
}

void TopicInlets::take(Simulation& simulation) {
  if (subscribers_.empty()) return;
  if (waits()) wait_for_sockets();
  simulation_ = &simulation;
  queue_.callAvailable();
}

/// roscpp reads its sockets in turns, and may read a command before an earlier message on another
/// socket. After the end of a turn that begins now, it has read that message.
void TopicInlets::wait_for_sockets() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (std::this_thread::get_id() == reader_) return;  // the publisher has just connected
  const std::int64_t next = turns_ + 1;
  while (turns_ <= next && ros::ok()) {
    ros::PollManager::instance()->getPollSet().signal();
    turned_.wait_for(lock, std::chrono::milliseconds(20));
  }
}

}  // namespace quadcore::node
