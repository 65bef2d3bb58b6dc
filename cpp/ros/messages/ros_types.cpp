#include "ros_types.hpp"

#include <geometry_msgs/Vector3Stamped.h>
#include <geometry_msgs/WrenchStamped.h>

#include <algorithm>
#include <type_traits>

#include "latched_publisher.hpp"
#include "messages.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"
#include "sensor_types.hpp"

namespace quadcore::node {
namespace {

using node::from_ros;
using node::set_frames;
using node::to_ros;

void set_frames(geometry_msgs::WrenchStamped& message, const MessageFrames& frames) {
  message.header.frame_id = frames.own;
}
void to_ros(const messages::Wrench& wrench, geometry_msgs::WrenchStamped& message) {
  set_vector(message.wrench.force, wrench.force.data());
  set_vector(message.wrench.torque, wrench.torque.data());
}
messages::Wrench from_ros(const geometry_msgs::WrenchStamped& message) {
  return {vector_of(message.wrench.force), vector_of(message.wrench.torque)};
}

void set_frames(geometry_msgs::Vector3Stamped&, const MessageFrames&) {
}  // the frame is that of the publisher
void to_ros(const messages::Vector& vector, geometry_msgs::Vector3Stamped& message) {
  set_vector(message.vector, vector.value.data());
}
messages::Vector from_ros(const geometry_msgs::Vector3Stamped& message) {
  return {vector_of(message.vector)};
}

/// Whether the stamp is the time of a measurement, also for delayed messages; otherwise it is the
/// end of the step.
template <class Message>
constexpr bool is_measured =
    !std::is_same_v<Message, messages::Wrench> && !std::is_same_v<Message, messages::Vector>;

template <class Message, class Ros>
class TypedOutlet final : public Outlet {
 public:
  TypedOutlet(ros::NodeHandle& nh, const std::string& name, const MessageFrames& frames)
      : publisher_(nh, name, queue_size) {
    set_frames(message_, frames);
  }
  void send(const Topic& topic, const ros::Time& stamp) override {
    message_.header.stamp = is_measured<Message> ? node::to_ros(topic.stamp) : stamp;
    to_ros(messages::read<Message>(topic.values.data()), message_);
    publisher_.publish(message_);
  }

 private:
  LatchedPublisher<Ros> publisher_;
  Ros message_;  // stored to reuse its memory
};

/// Publishes a fix: the position on NAME, and the velocity on NAME/velocity.
class FixOutlet final : public Outlet {
 public:
  FixOutlet(ros::NodeHandle& nh, const std::string& name, const MessageFrames& frames)
      : place_(nh, name, frames), velocity_(nh, name + "/velocity", frames) {}
  void send(const Topic& topic, const ros::Time& stamp) override {
    place_.send(topic, stamp);
    velocity_.send(topic, stamp);
  }

 private:
  TypedOutlet<messages::Fix, sensor_msgs::NavSatFix> place_;
  TypedOutlet<messages::Fix, geometry_msgs::TwistWithCovarianceStamped> velocity_;
};

bool is_scan(const MessageKind& kind) {
  const std::size_t fields = kind.fields.size();
  return fields > messages::scan_numbers && kind == messages::scan(fields - messages::scan_numbers);
}

/// Publishes a scan, of which the number of beams may differ from one topic to the next.
class ScanOutlet final : public Outlet {
 public:
  ScanOutlet(ros::NodeHandle& nh, const std::string& name, const MessageFrames& frames)
      : publisher_(nh, name, queue_size) {
    set_frames(message_, frames);
  }
  void send(const Topic& topic, const ros::Time&) override {
    message_.header.stamp = node::to_ros(topic.stamp);
    to_ros(topic.values, message_);
    publisher_.publish(message_);
  }

 private:
  LatchedPublisher<sensor_msgs::LaserScan> publisher_;
  sensor_msgs::LaserScan message_;
};

/// Publishes a kind without its own ROS type: the numbers, with their names as the label.
class ArrayOutlet final : public Outlet {
 public:
  ArrayOutlet(ros::NodeHandle& nh, const Topic& topic) : publisher_(nh, topic.path, queue_size) {
    add_dimension(message_, joined(topic.kind.fields), topic.kind.fields.size());
  }
  void send(const Topic& topic, const ros::Time&) override {
    message_.data = topic.values;
    publisher_.publish(message_);
  }

 private:
  LatchedPublisher<std_msgs::Float64MultiArray> publisher_;
  std_msgs::Float64MultiArray message_;
};

template <class Ros, class Act>
ros::Subscriber subscribe(ros::NodeHandle& nh, const std::string& name, const Act& act) {
  const boost::function<void(const boost::shared_ptr<const Ros>&)> callback =
      [act](const boost::shared_ptr<const Ros>& message) { act(*message); };
  return nh.subscribe<Ros>(name, queue_size, callback, ros::VoidConstPtr(),
                           ros::TransportHints().tcpNoDelay());
}

/// A kind of message and its ROS types.
struct Transport {
  MessageKind kind;
  std::unique_ptr<Outlet> (*outlet)(ros::NodeHandle&, const std::string&, const MessageFrames&);
  ros::Subscriber (*inlet)(ros::NodeHandle&, const std::string&, const Take&);
};

/// Transport of a kind that no single ROS type contains completely: it can only be published.
template <class Message, class Out>
Transport outgoing() {
  return {messages::kind_of<Message>(),
          [](ros::NodeHandle& nh, const std::string& name, const MessageFrames& frames)
              -> std::unique_ptr<Outlet> { return std::make_unique<Out>(nh, name, frames); },
          nullptr};
}

template <class Message, class Ros>
Transport transport() {
  Transport both_ways = outgoing<Message, TypedOutlet<Message, Ros>>();
  both_ways.inlet = [](ros::NodeHandle& nh, const std::string& name, const Take& take) {
    return subscribe<Ros>(nh, name, [take](const Ros& message) {
      std::vector<double> row(messages::kind_of<Message>().fields.size());
      messages::write(from_ros(message), row.data());
      take(row);
    });
  };
  return both_ways;
}

/// Returns the transport of a kind of message; null for an array of numbers.
const Transport* find_transport(const MessageKind& kind) {
  static const std::vector<Transport> table = {
      transport<messages::Odometry, nav_msgs::Odometry>(),
      transport<messages::Imu, sensor_msgs::Imu>(),
      transport<messages::Pressure, sensor_msgs::FluidPressure>(),
      transport<messages::Field, sensor_msgs::MagneticField>(),
      transport<messages::Battery, sensor_msgs::BatteryState>(),
      outgoing<messages::Fix, FixOutlet>(),
      outgoing<messages::Range, TypedOutlet<messages::Range, sensor_msgs::Range>>(),
      transport<messages::Wrench, geometry_msgs::WrenchStamped>(),
      transport<messages::Vector, geometry_msgs::Vector3Stamped>(),
  };
  const auto found = std::find_if(table.begin(), table.end(),
                                  [&](const Transport& entry) { return entry.kind == kind; });
  return found == table.end() ? nullptr : &*found;
}

}  // namespace

void check_name_is_free(ros::NodeHandle& nh, const std::string& name) {
  std::vector<std::string> published, subscribed;
  ros::this_node::getAdvertisedTopics(published);
  ros::this_node::getSubscribedTopics(subscribed);
  for (const auto& taken : {published, subscribed}) {
    if (std::find(taken.begin(), taken.end(), nh.resolveName(name)) == taken.end()) continue;
    throw InputError("topic '" + name + "' of a plugin has the name of a topic of the node. " +
                     "Give it another name.");
  }
}

void add_dimension(std_msgs::Float64MultiArray& array, const std::string& label, std::size_t size) {
  std_msgs::MultiArrayDimension dimension;
  dimension.label = label;
  dimension.size = dimension.stride = static_cast<std::uint32_t>(size);
  array.layout.dim.push_back(dimension);
}

void set_frames(nav_msgs::Odometry& message, const MessageFrames& frames) {
  message.header.frame_id = frames.parent;
  message.child_frame_id = frames.own;
}

void to_ros(const messages::Odometry& odometry, nav_msgs::Odometry& message) {
  set_vector(message.pose.pose.position, odometry.position.data());
  set_quaternion(message.pose.pose.orientation, odometry.orientation.coeffs().data());
  set_vector(message.twist.twist.linear, odometry.linear_velocity.data());
  set_vector(message.twist.twist.angular, odometry.angular_velocity.data());
  set_covariance(message.pose.covariance,
                 {odometry.position_variance, odometry.orientation_variance});
  set_covariance(message.twist.covariance,
                 {odometry.linear_velocity_variance, odometry.angular_velocity_variance});
}

messages::Odometry from_ros(const nav_msgs::Odometry& message) {
  messages::Odometry odometry;
  const geometry_msgs::Quaternion& q = message.pose.pose.orientation;
  odometry.position = vector_of(message.pose.pose.position);
  odometry.orientation = Quaterniond(q.w, q.x, q.y, q.z);
  odometry.linear_velocity = vector_of(message.twist.twist.linear);
  odometry.angular_velocity = vector_of(message.twist.twist.angular);
  odometry.position_variance = message.pose.covariance.front();
  odometry.orientation_variance = message.pose.covariance.back();
  odometry.linear_velocity_variance = message.twist.covariance.front();
  odometry.angular_velocity_variance = message.twist.covariance.back();
  return odometry;
}

std::unique_ptr<Outlet> make_outlet(ros::NodeHandle& nh, const Topic& topic,
                                    const MessageFrames& frames) {
  const Transport* const transport = find_transport(topic.kind);
  if (transport) return transport->outlet(nh, topic.path, frames);
  if (is_scan(topic.kind)) return std::make_unique<ScanOutlet>(nh, topic.path, frames);
  return std::make_unique<ArrayOutlet>(nh, topic);
}

ros::Subscriber make_inlet(ros::NodeHandle& nh, const Topic& topic, const Take& take) {
  check_name_is_free(nh, topic.path);
  const Transport* const transport = find_transport(topic.kind);
  if (transport && !transport->inlet) {
    throw InputError("topic '" + topic.path + "': no ROS type contains all of a " +
                     topic.kind.name + ". Let a plugin publish it.");
  }
  if (transport) return transport->inlet(nh, topic.path, take);
  return subscribe<std_msgs::Float64MultiArray>(
      nh, topic.path, [take](const std_msgs::Float64MultiArray& message) { take(message.data); });
}

}  // namespace quadcore::node
