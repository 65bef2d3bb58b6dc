#include "transform_publisher.hpp"

#include <ros/poll_manager.h>

#include <cstdint>
#include <mutex>

#include "caller_queue.hpp"

namespace quadcore::node {

/// roscpp's poll thread sends the queued messages, then calls the listeners, then accepts new
/// subscribers, in turn. What had been published before one call of a listener has therefore been
/// sent before the next call.
class TransformPublisher::Shared {
 public:
  Shared()
      : listener_(ros::PollManager::instance()->addPollThreadListener([this] { note_sent(); })) {}
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;
  ~Shared() {
    publisher_.shutdown();
    ros::PollManager::instance()->removePollThreadListener(listener_);
  }

  /// \param self  this object; roscpp may greet a subscriber while it is destroyed
  void advertise(ros::NodeHandle& nh, const std::shared_ptr<Shared>& self) {
    static CallerQueue queue;  // has no state
    ros::AdvertiseOptions options;
    options.init<tf2_msgs::TFMessage>(
        "/tf", 100,
        [weak = std::weak_ptr<Shared>(self)](const ros::SingleSubscriberPublisher& newcomer) {
          if (const std::shared_ptr<Shared> shared = weak.lock()) shared->greet(newcomer);
        });
    options.callback_queue = &queue;
    publisher_ = nh.advertise(options);
  }

  void publish(tf2_msgs::TFMessage& transforms, const ros::Time& time) {
    const std::lock_guard<std::mutex> lock(mutex_);
    stamp_ = published_ > 0 && time == time_ ? stamp_ + ros::Duration(0, 1) : time;
    time_ = time;
    for (geometry_msgs::TransformStamped& transform : transforms.transforms) {
      transform.header.stamp = stamp_;
    }
    last_ = transforms;
    ++published_;
    has_unserved_ = false;
    publisher_.publish(transforms);
  }

  bool has_unserved_subscriber() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return has_unserved_;
  }

 private:
  void greet(const ros::SingleSubscriberPublisher& newcomer) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (published_ == 0) return;
    if (sent_ == published_) {
      newcomer.publish(last_);
    } else {
      has_unserved_ = true;  // the last message may be in the queue, for the newcomer, too
    }
  }

  void note_sent() {
    const std::lock_guard<std::mutex> lock(mutex_);
    sent_ = before_;
    before_ = published_;
  }

  mutable std::mutex mutex_;
  ros::Publisher publisher_;
  tf2_msgs::TFMessage last_;
  ros::Time time_, stamp_;
  bool has_unserved_ = false;
  // Numbers of messages.
  std::uint64_t published_ = 0;
  std::uint64_t before_ = 0;              ///< published before the last call of the listener
  std::uint64_t sent_ = 0;                ///< certainly sent
  boost::signals2::connection listener_;  ///< last, since it is called from now on
};

TransformPublisher::TransformPublisher(ros::NodeHandle& nh) : shared_(std::make_shared<Shared>()) {
  shared_->advertise(nh, shared_);
}

void TransformPublisher::publish(tf2_msgs::TFMessage& transforms, const ros::Time& time) {
  shared_->publish(transforms, time);
}

bool TransformPublisher::has_unserved_subscriber() const {
  return shared_ && shared_->has_unserved_subscriber();
}

}  // namespace quadcore::node
