#include "rotors_types.hpp"

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <rotors_comm/WindSpeed.h>
#include <std_msgs/Float32.h>
#include <tf2_msgs/TFMessage.h>

#include "latched_publisher.hpp"
#include "messages.hpp"

namespace quadcore::node {
namespace {

constexpr const char* of_rotors = "librotors_gazebo_";
constexpr const char* motor_file = "librotors_gazebo_motor_model.so";
constexpr const char* odometry_file = "librotors_gazebo_odometry_plugin.so";

/// Publishes the speeds of all rotors.
class ActuatorsOutlet final : public Outlet {
 public:
  ActuatorsOutlet(ros::NodeHandle& nh, const std::string& name, const std::string& frame)
      : publisher_(nh, name, queue_size) {
    message_.header.frame_id = frame;
  }
  void send(const Topic& topic, const ros::Time& stamp) override {
    message_.header.stamp = stamp;
    message_.angular_velocities = topic.values;
    publisher_.publish(message_);
  }

 private:
  LatchedPublisher<mav_msgs::Actuators> publisher_;
  mav_msgs::Actuators message_;
};

/// Publishes the rate of one joint.
class RateOutlet final : public Outlet {
 public:
  RateOutlet(ros::NodeHandle& nh, const std::string& name) : publisher_(nh, name, queue_size) {}
  void send(const Topic& topic, const ros::Time&) override {
    message_.data = static_cast<float>(topic.values.front());
    publisher_.publish(message_);
  }

 private:
  LatchedPublisher<std_msgs::Float32> publisher_;
  std_msgs::Float32 message_;
};

/// Publishes the velocity of a satellite receiver.
class GroundSpeedOutlet final : public Outlet {
 public:
  GroundSpeedOutlet(ros::NodeHandle& nh, const std::string& name, const std::string& frame)
      : publisher_(nh, name, queue_size) {
    message_.header.frame_id = frame;
  }
  void send(const Topic& topic, const ros::Time&) override {
    message_.header.stamp = node::to_ros(topic.stamp);
    set_vector(message_.twist.linear, topic.values.data());
    publisher_.publish(message_);
  }

 private:
  LatchedPublisher<geometry_msgs::TwistStamped> publisher_;
  geometry_msgs::TwistStamped message_;
};

class WindOutlet final : public Outlet {
 public:
  WindOutlet(ros::NodeHandle& nh, const std::string& name, const std::string& frame)
      : publisher_(nh, name, queue_size) {
    message_.header.frame_id = frame;
  }
  void send(const Topic& topic, const ros::Time& stamp) override {
    message_.header.stamp = stamp;
    set_vector(message_.velocity, topic.values.data());
    publisher_.publish(message_);
  }

 private:
  LatchedPublisher<rotors_comm::WindSpeed> publisher_;
  rotors_comm::WindSpeed message_;
};

/// Publishes an odometry, and its pose in four more types and on tf.
class OdometryOutlet final : public Outlet {
 public:
  OdometryOutlet(ros::NodeHandle& nh, const Topic& topic, const LoadedPlugin& writer,
                 const MessageFrames& frames, bool tf)
      : odometry_publisher_(nh, topic.path, queue_size) {
    // The prefix of its topics, from the module's own namespace.
    const std::string& own = writer.parameters.text("odometryTopic");
    const std::string before = topic.path.substr(0, topic.path.size() - own.size());
    const auto name = [&](const char* tag) { return before + writer.parameters.text(tag); };
    pose_publisher_ = {nh, name("poseTopic"), queue_size};
    variance_publisher_ = {nh, name("poseWithCovarianceTopic"), queue_size};
    position_publisher_ = {nh, name("positionTopic"), queue_size};
    transform_publisher_ = {nh, name("transformTopic"), queue_size};
    if (tf) tf_publisher_ = nh.advertise<tf2_msgs::TFMessage>("/tf", 100);
    set_frames(odometry_, frames);
    tf_.transforms.resize(1);
    tf_.transforms.front().child_frame_id = frames.own;
  }

  void send(const Topic& topic, const ros::Time&) override {
    odometry_.header.stamp = node::to_ros(topic.stamp);
    to_ros(messages::read<messages::Odometry>(topic.values.data()), odometry_);
    odometry_publisher_.publish(odometry_);
    const geometry_msgs::Pose& pose = odometry_.pose.pose;
    pose_publisher_.publish(pose);
    with_variance_.header = position_.header = odometry_.header;
    with_variance_.pose = odometry_.pose;
    variance_publisher_.publish(with_variance_);
    position_.point = pose.position;
    position_publisher_.publish(position_);
    geometry_msgs::TransformStamped& transform = tf_.transforms.front();
    transform.header = odometry_.header;
    set_vector(transform.transform.translation, topic.values.data());
    transform.transform.rotation = pose.orientation;
    transform_publisher_.publish(transform);
    if (tf_publisher_) tf_publisher_.publish(tf_);
  }

 private:
  LatchedPublisher<nav_msgs::Odometry> odometry_publisher_;
  LatchedPublisher<geometry_msgs::Pose> pose_publisher_;
  LatchedPublisher<geometry_msgs::PoseWithCovarianceStamped> variance_publisher_;
  LatchedPublisher<geometry_msgs::PointStamped> position_publisher_;
  LatchedPublisher<geometry_msgs::TransformStamped> transform_publisher_;
  ros::Publisher tf_publisher_;
  nav_msgs::Odometry odometry_;
  geometry_msgs::PoseWithCovarianceStamped with_variance_;
  geometry_msgs::PointStamped position_;
  tf2_msgs::TFMessage tf_;
};

}  // namespace

std::unique_ptr<Outlet> make_rotors_outlet(ros::NodeHandle& nh, const Topic& topic,
                                           const LoadedPlugin& writer, const MessageFrames& frames,
                                           const std::string& root_frame) {
  if (writer.filename.rfind(of_rotors, 0) != 0) return nullptr;
  const std::string& kind = topic.kind.name;
  if (kind == messages::speeds(0).name) {
    return std::make_unique<ActuatorsOutlet>(nh, topic.path, frames.own);
  }
  if (kind == messages::motor_speed().name) return std::make_unique<RateOutlet>(nh, topic.path);
  if (kind == messages::WindSpeed::kind) {
    return std::make_unique<WindOutlet>(nh, topic.path, frames.own);
  }
  if (kind == messages::GroundSpeed::kind) {
    return std::make_unique<GroundSpeedOutlet>(nh, topic.path, frames.parent);
  }
  if (writer.filename != odometry_file) return nullptr;
  return std::make_unique<OdometryOutlet>(nh, topic, writer, frames, frames.own != root_frame);
}

std::string direct_motor_topic(const Simulation& simulation) {
  for (const LoadedPlugin& plugin : simulation.plugins()) {
    if (plugin.filename == motor_file) return plugin.parameters.text("commandSubTopic");
  }
  return "";
}

}  // namespace quadcore::node
