#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/spatial.hpp"

/// \file
/// The kinds of message that topics carry. Each is a type with one list of its fields: plugins,
/// logs, Python and the ROS node all go by that list.

namespace quadcore QUADCORE_EXPORT {

/// What the row of numbers of a topic means. A plugin may make a kind of its own.
struct MessageKind {
  std::string name;                 ///< by which bridges and errors know it
  std::vector<std::string> fields;  ///< names of the numbers, in order
  /// What whoever takes the topic goes by before the first message, a number for each field; empty
  /// where no number says it, and the topic holds zeros then.
  std::vector<double> unsaid = {};
  std::string meaning = {};  ///< of the numbers, with their units, for people

  /// Whether messages mean the same.
  bool operator==(const MessageKind& other) const {
    return name == other.name && fields == other.fields;
  }
};

/// Types of message. Such a type M, also one of a plugin's own, has `kind`, the MessageKind::name,
/// its `meaning`, and `M::for_each_field(m, visit)`, which calls `visit(member, {field,
/// ...}, numbers)` with the names and the numbers of each member in order.
namespace messages {

/// Names of numbers that lie side by side.
using Names = std::initializer_list<const char*>;

/// Visits a member that is one field and has its name.
template <class Visit, class Number>
void visit_number(const Visit& visit, const char* name, Number& number) {
  visit(name, {name}, &number);
}

/// Pose of the frame in the world and its velocity, with the variance of the noise on each.
struct Odometry {
  static constexpr const char* kind = "odometry";  ///< MessageKind::name
  /// MessageKind::meaning
  static constexpr const char* meaning = "units as in the log, variances in their squares";
  Vector3d position = Vector3d::Zero();               ///< world axes [m]
  Quaterniond orientation = Quaterniond::Identity();  ///< of the frame in the world, unit
  Vector3d linear_velocity =
      Vector3d::Zero();  ///< of the frame's origin, axes as the publisher says [m/s]
  Vector3d angular_velocity = Vector3d::Zero();  ///< frame axes [rad/s]
  double position_variance = 0;                  ///< of each component [m^2]
  double orientation_variance = 0;               ///< about each axis [rad^2]
  double linear_velocity_variance = 0;           ///< of each component [m^2/s^2]
  double angular_velocity_variance = 0;          ///< of each component [rad^2/s^2]

  template <class M, class Visit>
  static void for_each_field(M& m, const Visit& visit) {
    visit("position", {"x", "y", "z"}, m.position.data());
    visit("orientation", {"qx", "qy", "qz", "qw"}, m.orientation.coeffs().data());
    visit("linear_velocity", {"vx", "vy", "vz"}, m.linear_velocity.data());
    visit("angular_velocity", {"wx", "wy", "wz"}, m.angular_velocity.data());
    visit_number(visit, "position_variance", m.position_variance);
    visit_number(visit, "orientation_variance", m.orientation_variance);
    visit_number(visit, "linear_velocity_variance", m.linear_velocity_variance);
    visit_number(visit, "angular_velocity_variance", m.angular_velocity_variance);
  }
};

/// Measurement of an inertial measurement unit, in its own axes.
struct Imu {
  static constexpr const char* kind = "imu";  ///< MessageKind::name
  /// MessageKind::meaning
  static constexpr const char* meaning =
      "angular velocity, rad/s, and specific force, m/s^2, link axes, and their variances";
  Vector3d angular_velocity = Vector3d::Zero();  ///< [rad/s]
  Vector3d specific_force = Vector3d::Zero();    ///< acceleration less gravity [m/s^2]
  double angular_velocity_variance = 0;          ///< of each component [rad^2/s^2]
  double specific_force_variance = 0;            ///< of each component [m^2/s^4]

  template <class M, class Visit>
  static void for_each_field(M& m, const Visit& visit) {
    visit("angular_velocity", {"wx", "wy", "wz"}, m.angular_velocity.data());
    visit("specific_force", {"ax", "ay", "az"}, m.specific_force.data());
    visit_number(visit, "angular_velocity_variance", m.angular_velocity_variance);
    visit_number(visit, "specific_force_variance", m.specific_force_variance);
  }
};

/// Measurement of a satellite receiver: position on Earth and in the world, and velocity.
struct Fix {
  static constexpr const char* kind = "fix";  ///< MessageKind::name
  /// MessageKind::meaning
  static constexpr const char* meaning =
      "degrees, m, m/s, and variances; position and velocity in world axes";
  double latitude = 0;                   ///< positive north [deg]
  double longitude = 0;                  ///< positive east [deg]
  double altitude = 0;                   ///< [m]
  Vector3d position = Vector3d::Zero();  ///< the same position in world axes [m]
  Vector3d velocity = Vector3d::Zero();  ///< world axes [m/s]
  double horizontal_variance = 0;        ///< of x and y each [m^2]
  double vertical_variance = 0;          ///< of z [m^2]
  double velocity_variance = 0;          ///< of each component [m^2/s^2]

  template <class M, class Visit>
  static void for_each_field(M& m, const Visit& visit) {
    visit_number(visit, "latitude", m.latitude);
    visit_number(visit, "longitude", m.longitude);
    visit_number(visit, "altitude", m.altitude);
    visit("position", {"x", "y", "z"}, m.position.data());
    visit("velocity", {"vx", "vy", "vz"}, m.velocity.data());
    visit_number(visit, "horizontal_variance", m.horizontal_variance);
    visit_number(visit, "vertical_variance", m.vertical_variance);
    visit_number(visit, "velocity_variance", m.velocity_variance);
  }
};

/// Measurement of a barometer.
struct Pressure {
  static constexpr const char* kind = "pressure";  ///< MessageKind::name
  /// MessageKind::meaning
  static constexpr const char* meaning = "static pressure of the air, Pa, and its variance";
  double pressure = 0;  ///< static, of the air [Pa]
  double variance = 0;  ///< [Pa^2]

  template <class M, class Visit>
  static void for_each_field(M& m, const Visit& visit) {
    visit_number(visit, "pressure", m.pressure);
    visit_number(visit, "variance", m.variance);
  }
};

/// Measurement of a magnetometer, in its own axes.
struct Field {
  static constexpr const char* kind = "field";  ///< MessageKind::name
  /// MessageKind::meaning
  static constexpr const char* meaning = "magnetic flux density, T, link axes, and its variance";
  Vector3d flux_density = Vector3d::Zero();  ///< [T]
  double variance = 0;                       ///< of each component [T^2]

  template <class M, class Visit>
  static void for_each_field(M& m, const Visit& visit) {
    visit("flux_density", {"x", "y", "z"}, m.flux_density.data());
    visit_number(visit, "variance", m.variance);
  }
};

/// State of a battery.
struct Battery {
  static constexpr const char* kind = "battery";  ///< MessageKind::name
  /// MessageKind::meaning
  static constexpr const char* meaning = "V, A drawn, A h left, A h of a full one";
  double voltage = 0;   ///< between its poles [V]
  double current = 0;   ///< drawn from it [A]
  double charge = 0;    ///< that is left [A h]
  double capacity = 0;  ///< charge of a full one [A h]

  template <class M, class Visit>
  static void for_each_field(M& m, const Visit& visit) {
    visit_number(visit, "voltage", m.voltage);
    visit_number(visit, "current", m.current);
    visit_number(visit, "charge", m.charge);
    visit_number(visit, "capacity", m.capacity);
  }
};

/// Desired state of a vehicle, with the derivatives of a flat output, world axes.
struct Reference {
  static constexpr const char* kind = "reference";  ///< MessageKind::name
  /// MessageKind::meaning
  static constexpr const char* meaning =
      "desired position, its derivatives, and yaw; world axes, m, rad, s";
  Vector3d position = Vector3d::Zero();      ///< of the frame's origin [m]
  Vector3d velocity = Vector3d::Zero();      ///< [m/s]
  Vector3d acceleration = Vector3d::Zero();  ///< [m/s^2]
  Vector3d jerk = Vector3d::Zero();          ///< [m/s^3]
  Vector3d snap = Vector3d::Zero();          ///< [m/s^4]
  double yaw = 0;                            ///< [rad]
  double yaw_rate = 0;                       ///< [rad/s]
  double yaw_acceleration = 0;               ///< [rad/s^2]

  template <class M, class Visit>
  static void for_each_field(M& m, const Visit& visit) {
    visit("position", {"x", "y", "z"}, m.position.data());
    visit("velocity", {"vx", "vy", "vz"}, m.velocity.data());
    visit("acceleration", {"ax", "ay", "az"}, m.acceleration.data());
    visit("jerk", {"jx", "jy", "jz"}, m.jerk.data());
    visit("snap", {"sx", "sy", "sz"}, m.snap.data());
    visit_number(visit, "yaw", m.yaw);
    visit_number(visit, "yaw_rate", m.yaw_rate);
    visit_number(visit, "yaw_acceleration", m.yaw_acceleration);
  }
};

/// A force at a point and a torque; point and axes are the taker's.
struct Wrench {
  static constexpr const char* kind = "wrench";  ///< MessageKind::name
  /// MessageKind::meaning
  static constexpr const char* meaning = "force, N, and torque, N m";
  Vector3d force = Vector3d::Zero();   ///< [N]
  Vector3d torque = Vector3d::Zero();  ///< about the point [N m]

  template <class M, class Visit>
  static void for_each_field(M& m, const Visit& visit) {
    visit("force", {"fx", "fy", "fz"}, m.force.data());
    visit("torque", {"tx", "ty", "tz"}, m.torque.data());
  }
};

/// A vector of space; axes and unit are the publisher's.
struct Vector {
  static constexpr const char* kind = "vector";  ///< MessageKind::name
  /// MessageKind::meaning
  static constexpr const char* meaning = "a vector; the publisher defines axes and unit";
  Vector3d value = Vector3d::Zero();  ///< x, y, z

  template <class M, class Visit>
  static void for_each_field(M& m, const Visit& visit) {
    visit("value", {"x", "y", "z"}, m.value.data());
  }
};

/// How the air moves, world axes.
struct WindSpeed {
  static constexpr const char* kind = "wind_speed";  ///< MessageKind::name
  /// MessageKind::meaning
  static constexpr const char* meaning = "velocity of the air, world axes, m/s";
  Vector3d velocity = Vector3d::Zero();  ///< [m/s]

  template <class M, class Visit>
  static void for_each_field(M& m, const Visit& visit) {
    visit("velocity", {"x", "y", "z"}, m.velocity.data());
  }
};

/// How a satellite receiver moves, world axes.
struct GroundSpeed {
  static constexpr const char* kind = "ground_speed";  ///< MessageKind::name
  /// MessageKind::meaning
  static constexpr const char* meaning = "velocity of the receiver, world axes, m/s";
  Vector3d velocity = Vector3d::Zero();  ///< [m/s]

  template <class M, class Visit>
  static void for_each_field(M& m, const Visit& visit) {
    visit("velocity", {"x", "y", "z"}, m.velocity.data());
  }
};

/// The rate of one joint [rad/s].
inline MessageKind motor_speed() { return {"motor_speed", {"w"}, {}, "joint rate, rad/s"}; }

/// Speeds of as many rotors as there are, signed [rad/s], before any division by sim_slow.
inline MessageKind speeds(std::size_t rotors) {
  MessageKind kind{
      "speeds", {}, {}, "rotor speeds, rad/s, signed, before the division by `sim_slow`"};
  for (std::size_t i = 0; i < rotors; ++i) kind.fields.push_back("w" + std::to_string(i + 1));
  return kind;
}

/// The members of a type of message, and the fields that each is.
template <class M>
std::vector<std::pair<std::string, std::vector<std::string>>> parts_of() {
  std::vector<std::pair<std::string, std::vector<std::string>>> parts;
  M any;
  M::for_each_field(any, [&parts](const char* part, Names fields, const double*) {
    parts.emplace_back(part, std::vector<std::string>(fields.begin(), fields.end()));
  });
  return parts;
}

/// The kind that a type of message is; `meaning` may be narrower than the type's own.
template <class M>
MessageKind kind_of(const char* meaning = M::meaning) {
  MessageKind kind{M::kind, {}, {}, meaning};
  for (const auto& [part, fields] : parts_of<M>()) {
    kind.fields.insert(kind.fields.end(), fields.begin(), fields.end());
  }
  return kind;
}

/// Writes a message as a row of numbers.
template <class M>
void write(const M& message, double* row) {
  M::for_each_field(message, [&row](const char*, Names fields, const double* values) {
    row = std::copy_n(values, fields.size(), row);
  });
}

/// The message that a row of numbers is.
template <class M>
M read(const double* row) {
  M message;
  M::for_each_field(message, [&row](const char*, Names fields, double* values) {
    std::copy_n(row, fields.size(), values);
    row += fields.size();
  });
  return message;
}

}  // namespace messages
}  // namespace quadcore
