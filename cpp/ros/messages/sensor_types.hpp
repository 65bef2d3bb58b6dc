#pragma once

#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <sensor_msgs/BatteryState.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/MagneticField.h>
#include <sensor_msgs/NavSatFix.h>
#include <sensor_msgs/Range.h>

#include "frames.hpp"
#include "messages.hpp"
#include "quadcore/plugin/messages.hpp"
#include "quadcore/range_messages.hpp"

/// \file
/// Sensor messages in ROS types. Their own frame is that of the sensor's link.

namespace quadcore::node {

/// Variance of numbers that a message cannot omit.
constexpr double unknown_variance = 1e9;

template <class Ros>
void set_frames(Ros& message, const MessageFrames& frames) {
  message.header.frame_id = frames.own;
}

inline void set_frames(sensor_msgs::Imu& message, const MessageFrames& frames) {
  message.header.frame_id = frames.own;
  message.orientation_covariance[0] = -1;  // no orientation
}
inline void to_ros(const messages::Imu& imu, sensor_msgs::Imu& message) {
  set_vector(message.angular_velocity, imu.angular_velocity.data());
  set_vector(message.linear_acceleration, imu.specific_force.data());
  set_covariance(message.angular_velocity_covariance, {imu.angular_velocity_variance});
  set_covariance(message.linear_acceleration_covariance, {imu.specific_force_variance});
}
inline messages::Imu from_ros(const sensor_msgs::Imu& message) {
  messages::Imu imu;
  imu.angular_velocity = vector_of(message.angular_velocity);
  imu.specific_force = vector_of(message.linear_acceleration);
  imu.angular_velocity_variance = message.angular_velocity_covariance[0];
  imu.specific_force_variance = message.linear_acceleration_covariance[0];
  return imu;
}

inline void to_ros(const messages::Pressure& pressure, sensor_msgs::FluidPressure& message) {
  message.fluid_pressure = pressure.pressure;
  message.variance = std::max(pressure.variance, min_variance);
}
inline messages::Pressure from_ros(const sensor_msgs::FluidPressure& message) {
  return {message.fluid_pressure, message.variance};
}

inline void to_ros(const messages::Field& field, sensor_msgs::MagneticField& message) {
  set_vector(message.magnetic_field, field.flux_density.data());
  // The minimum variance would be large in T^2.
  for (const std::size_t i : {0, 4, 8}) message.magnetic_field_covariance[i] = field.variance;
}
inline messages::Field from_ros(const sensor_msgs::MagneticField& message) {
  return {vector_of(message.magnetic_field), message.magnetic_field_covariance[0]};
}

inline void set_frames(sensor_msgs::Range& message, const MessageFrames& frames) {
  message.header.frame_id = frames.own;
  message.radiation_type = sensor_msgs::Range::INFRARED;
}
inline void to_ros(const messages::Range& range, sensor_msgs::Range& message) {
  message.range = static_cast<float>(range.range);
  message.min_range = static_cast<float>(range.minimum);
  message.max_range = static_cast<float>(range.maximum);
}

/// Fill a message from the numbers of messages::scan().
inline void to_ros(const std::vector<double>& scan, sensor_msgs::LaserScan& message) {
  const std::size_t beams = scan.size() - messages::scan_numbers;
  message.angle_min = static_cast<float>(scan[0]);
  message.angle_increment = static_cast<float>(scan[1]);
  message.angle_max = static_cast<float>(scan[0] + static_cast<double>(beams - 1) * scan[1]);
  message.range_min = static_cast<float>(scan[2]);
  message.range_max = static_cast<float>(scan[3]);
  message.ranges.assign(scan.begin() + messages::scan_numbers, scan.end());
}

inline void to_ros(const messages::Battery& battery, sensor_msgs::BatteryState& message) {
  message.present = true;
  message.power_supply_status = sensor_msgs::BatteryState::POWER_SUPPLY_STATUS_DISCHARGING;
  message.voltage = static_cast<float>(battery.voltage);
  message.current =
      -static_cast<float>(battery.current);  // in this type, a discharging current is negative
  message.charge = static_cast<float>(battery.charge);
  message.capacity = message.design_capacity = static_cast<float>(battery.capacity);
  message.percentage = static_cast<float>(battery.charge / battery.capacity);
}
inline messages::Battery from_ros(const sensor_msgs::BatteryState& message) {
  return {message.voltage, -message.current, message.charge, message.capacity};
}

inline void to_ros(const messages::Fix& fix, sensor_msgs::NavSatFix& message) {
  message.status.service = sensor_msgs::NavSatStatus::SERVICE_GPS;
  message.latitude = fix.latitude;
  message.longitude = fix.longitude;
  message.altitude = fix.altitude;
  // East, north and up are the world's axes.
  message.position_covariance[0] = std::max(fix.horizontal_variance, min_variance);
  message.position_covariance[4] = message.position_covariance[0];
  message.position_covariance[8] = std::max(fix.vertical_variance, min_variance);
  message.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_DIAGONAL_KNOWN;
}

inline void set_frames(geometry_msgs::TwistWithCovarianceStamped& message,
                       const MessageFrames& frames) {
  message.header.frame_id = frames.parent;
}
inline void to_ros(const messages::Fix& fix, geometry_msgs::TwistWithCovarianceStamped& message) {
  set_vector(message.twist.twist.linear, fix.velocity.data());
  set_covariance(message.twist.covariance, {fix.velocity_variance, unknown_variance});
}

}  // namespace quadcore::node
