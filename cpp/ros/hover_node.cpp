#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <std_msgs/Float64MultiArray.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>

namespace {

/// Holds the altitude of the shipped quadrotor and keeps it level: the smallest controller that
/// shows the topics at work. It is no position controller: the vehicle may drift. Another robot
/// than the shipped one wants other constants.
class Hover {
 public:
  explicit Hover(const std::string& model) {
    ros::NodeHandle nh, own("~");
    own.param("altitude", altitude_, altitude_);
    publisher_ = nh.advertise<std_msgs::Float64MultiArray>(model + "/vel_cmd", 1);
    subscriber_ =
        nh.subscribe("odom", 1, &Hover::control, this, ros::TransportHints().tcpNoDelay());
    command_.data.resize(4);
    check_ = nh.createWallTimer(ros::WallDuration(5), &Hover::check, this, true);
  }

 private:
  void check(const ros::WallTimerEvent&) {
    if (publisher_.getNumSubscribers() > 0) return;
    ROS_WARN("nobody takes commands on %s; give the robot's name as _model:=NAME",
             publisher_.getTopic().c_str());
  }

  void control(const nav_msgs::Odometry& odometry) {
    const auto& q = odometry.pose.pose.orientation;
    const auto& rate = odometry.twist.twist.angular;
    // The world's vertical in body axes, y and x: sines of roll and pitch near level flight.
    const double roll = 2 * (q.w * q.x + q.y * q.z);
    const double pitch = 2 * (q.w * q.y - q.z * q.x);

    const double climb = std::clamp(altitude_ - odometry.pose.pose.position.z, -1.0, 1.0);
    const double lift = mass * (gravity + 4 * climb - 4 * odometry.twist.twist.linear.z);
    const double roll_torque = -attitude_gain * roll - rate_gain * rate.x;
    const double pitch_torque = -attitude_gain * pitch - rate_gain * rate.y;

    // Rotor 1 stands at +x, 2 at -y, 3 at -x, 4 at +y; 2 and 4 turn the other way.
    const double x = pitch_torque / (2 * arm), y = roll_torque / (2 * arm);
    const double thrust[] = {lift / 4 - x, lift / 4 - y, lift / 4 + x, lift / 4 + y};
    for (std::size_t i = 0; i < 4; ++i) {
      const double speed = std::sqrt(std::max(thrust[i], 0.0) / thrust_coefficient);
      command_.data[i] = i % 2 == 0 ? speed : -speed;
    }
    publisher_.publish(command_);
  }

  static constexpr double mass = 1.04;                     // kg
  static constexpr double gravity = 9.8;                   // m/s^2
  static constexpr double arm = 0.2;                       // m
  static constexpr double thrust_coefficient = 1.1487e-5;  // N s^2
  static constexpr double attitude_gain = 0.4;             // N m
  static constexpr double rate_gain = 0.1;                 // N m s

  double altitude_ = 1;  // m
  ros::WallTimer check_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  std_msgs::Float64MultiArray command_;
};

/// Name of the robot in robot_description, the shipped one's where there is none.
std::string robot_name() {
  std::string where, text;
  std::smatch match;
  const ros::NodeHandle nh;
  if (nh.searchParam("robot_description", where)) nh.getParam(where, text);
  const std::regex name("<robot\\s[^>]*?\\bname\\s*=\\s*[\"']([^\"']+)");
  return std::regex_search(text, match, name) ? match[1].str() : "quadrotor";
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "hover");
  const Hover hover(ros::NodeHandle("~").param("model", robot_name()));
  ros::spin();
}
