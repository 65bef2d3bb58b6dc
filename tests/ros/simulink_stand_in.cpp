#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <std_msgs/Float64MultiArray.h>

#include <cstdlib>

/// \file
/// A node as Simulink generates them: it steps by the clock of the wall at a rate of its own, knows
/// the newest message alone, and asks nobody to send without delay. It sends as many commands as
/// its argument says, which its test knows beforehand.

namespace {

/// Speeds that binary numbers hold exactly.
std_msgs::Float64MultiArray command(int step) {
  std_msgs::Float64MultiArray message;
  for (int rotor = 0; rotor < 4; ++rotor) {
    const double speed = 470 + 0.5 * ((step * (rotor + 3)) % 11);
    message.data.push_back(rotor % 2 == 0 ? speed : -speed);
  }
  return message;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "simulink_stand_in");
  ros::NodeHandle nh;
  const int steps = argc > 1 ? std::atoi(argv[1]) : 0;
  nav_msgs::Odometry newest;
  const boost::function<void(const nav_msgs::Odometry&)> hear =
      [&newest](const nav_msgs::Odometry& message) { newest = message; };
  const ros::Subscriber odometry = nh.subscribe<nav_msgs::Odometry>("odom", 1, hear);
  const ros::Publisher commands =
      nh.advertise<std_msgs::Float64MultiArray>("quadrotor/vel_cmd", 1000);
  const ros::WallDuration moment(0.01);
  while (ros::ok() && commands.getNumSubscribers() == 0) moment.sleep();
  ros::WallRate rate(1000);
  for (int step = 0; ros::ok() && step < steps; ++step) {
    ros::spinOnce();
    commands.publish(command(step));
    rate.sleep();
  }
  ros::spin();
}
