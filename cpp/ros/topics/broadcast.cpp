#include "broadcast.hpp"

#include "messages.hpp"
#include "quadcore/urdf_tree.hpp"

namespace quadcore::node {
namespace {

constexpr bool kept = true;  ///< latched

}  // namespace

Broadcast::Broadcast(ros::NodeHandle& nh, const Simulation& simulation, const ClockPublisher& clock,
                     const Frames& frames, GazeboStates& gazebo_states, bool rotor_tf)
    : odometry_topic_(simulation),
      clock_publisher_(clock),
      path_(nh, frames.world),
      gazebo_states_(gazebo_states) {
  joint_states_publisher_ = nh.advertise<sensor_msgs::JointState>(joint_states_topic, 100, kept);
  const Model& model = simulation.model();
  joint_states_.name = model.joint_names();
  if (odometry_topic_.exists()) {
    advertise_odometry(nh, frames, simulation, rotor_tf);
  } else {
    ROS_WARN(
        "No plugin of the model publishes odometry on topic odom. The node publishes neither odom "
        "nor tf.");
  }
  send_static_frames(nh, model, frames);
  // Last, so that no plugin takes the name of one of these topics.
  others_.emplace(nh, simulation, frames, OdometryTopic::name);
}

void Broadcast::advertise_odometry(ros::NodeHandle& nh, const Frames& frames,
                                   const Simulation& simulation, bool rotor_tf) {
  const Model& model = simulation.model();
  const bool of_plugin = simulation.topics().find(truth_topic) >= 0;  // as for RotorS' vehicles
  odometry_publisher_ = {nh, OdometryTopic::name, 1000};
  if (!of_plugin) truth_publisher_ = nh.advertise<nav_msgs::Odometry>(truth_topic, 1000, kept);
  for (nav_msgs::Odometry* const message : {&odometry_, &truth_}) {
    set_frames(*message, {frames.world, frames.vehicle});
  }
  if (!odometry_topic_.publishes_tf()) return;
  tf_publisher_ = TransformPublisher(nh);
  transforms_.transforms.push_back(make_identity_transform(frames.world, frames.vehicle));
  if (rotor_tf) add_rotor_frames(model, frames);
}

/// Publishes links on joints that do not move, which robot_state_publisher would not send without
/// joint states.
void Broadcast::send_static_frames(ros::NodeHandle& nh, const Model& model, const Frames& frames) {
  tf2_msgs::TFMessage message;
  const std::string root_frame = frames.of_link(model.links.front().name);
  if (tf_publisher_ && !frames.map.empty()) {
    message.transforms.push_back(make_identity_transform(frames.map, frames.world));
  }
  // The root of the URDF is its root link; that of tf is the frame of the vehicle.
  if (tf_publisher_ && root_frame != frames.vehicle) {
    message.transforms.push_back(make_identity_transform(frames.vehicle, root_frame));
  }
  for (const UrdfJoint& joint : model.urdf->joints) {
    if (!joint.fixed && !joint.locked) continue;
    message.transforms.push_back(
        make_transform(frames.of_link(joint.parent), frames.of_link(joint.child), joint.pose));
  }
  if (message.transforms.empty()) return;
  static_tf_publisher_ = nh.advertise<tf2_msgs::TFMessage>("/tf_static", 100, kept);
  static_tf_publisher_.publish(message);
}

void Broadcast::send(const Simulation& simulation, bool jumped) {
  clock_.clock = to_ros(simulation.time());
  if (clock_publisher_) clock_publisher_.publish(clock_, jumped);
  gazebo_states_.send(simulation);
  others_->send(simulation, clock_.clock, jumped);
  if (odometry_topic_.exists()) {
    const Topic& topic = odometry_topic_.in(simulation);
    if (topic.count > 0 && (topic.count != sent_ || jumped)) send_odometry(simulation, topic);
  }
  if (joint_states_due_.due(simulation.time(), jumped)) send_joint_states(simulation.state());
  path_.add(simulation.state(), clock_.clock, jumped);
}

void Broadcast::show(const Simulation& simulation) {
  clock_.clock = to_ros(simulation.time());
  if (clock_publisher_) clock_publisher_.publish(clock_, true);
  send_joint_states(simulation.state());
  send_truth(simulation.state());
  if (tf_publisher_) send_transforms(simulation);
  gazebo_states_.send(simulation);
}

void Broadcast::offer(const Simulation& simulation) {
  if (!odometry_topic_.exists()) return;
  const Topic& topic = odometry_topic_.in(simulation);
  if (topic.count == 0) return;
  fill_odometry(topic);
  odometry_publisher_.offer(odometry_);
}

void Broadcast::serve_new_subscribers(const Simulation& simulation) {
  if (tf_publisher_.has_unserved_subscriber()) send_transforms(simulation);
}

void Broadcast::send_odometry(const Simulation& simulation, const Topic& topic) {
  sent_ = topic.count;
  fill_odometry(topic);
  odometry_publisher_.publish(odometry_);
  send_truth(simulation.state());
  if (tf_publisher_) send_transforms(simulation);
}

void Broadcast::fill_odometry(const Topic& topic) {
  odometry_.header.stamp = to_ros(topic.stamp);  // earlier for a delayed odometry
  to_ros(messages::read<messages::Odometry>(topic.values.data()), odometry_);
}

void Broadcast::send_truth(const VehicleState& state) {
  if (!truth_publisher_) return;
  truth_.header.stamp = clock_.clock;
  to_ros(odometry_topic_.truth(state), truth_);
  truth_publisher_.publish(truth_);
}

void Broadcast::add_rotor_frames(const Model& model, const Frames& frames) {
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    transforms_.transforms.push_back(make_transform(frames.of_link(model.links[joint.parent].name),
                                                    frames.of_link(model.links[i + 1].name),
                                                    joint.pose));
  }
}

void Broadcast::send_transforms(const Simulation& simulation) {
  const VehicleState& state = simulation.state();
  to_ros(state, transforms_.transforms.front().transform);
  for (std::size_t i = 1; i < transforms_.transforms.size(); ++i) {
    const Joint& joint = simulation.model().joints[i - 1];
    const double angle = state.rotor_angle[static_cast<Eigen::Index>(i - 1)];
    const Quaterniond turned = joint.pose.rotation() * Eigen::AngleAxisd(angle, joint.axis);
    set_quaternion(transforms_.transforms[i].transform.rotation, turned.coeffs().data());
  }
  tf_publisher_.publish(transforms_, clock_.clock);
}

void Broadcast::send_joint_states(const VehicleState& state) {
  joint_states_.header.stamp = clock_.clock;
  to_ros(state, joint_states_);
  joint_states_publisher_.publish(joint_states_);
}

}  // namespace quadcore::node
