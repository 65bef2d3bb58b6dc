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
/// Kinds of messages on topics. Each is a type with a list of its fields, which plugins, logs,
/// Python and the ROS node share.

namespace quadcore QUADCORE_EXPORT {

/// Meaning of the values of a topic. Plugins may define their own kinds.
struct MessageKind {
  std::string name;                 ///< name for bridges and error messages
  std::vector<std::string> fields;  ///< names of the values, in order
  /// Values that readers assume before the first message, one for each field; if empty, the topic
  /// contains zeros without meaning until then.
  std::vector<double> unsaid = {};
  std::string meaning = {};  ///< meaning of the values with their units, for documentation

  /// Return whether messages have the same meaning.
  bool operator==(const MessageKind& other) const {
    return name == other.name && fields == other.fields;
  }
};

/// Message types. A type M, which a plugin may also define, has `kind` (the MessageKind::name),
/// `meaning`, and `M::for_each_field(m, visit)`, which calls `visit(member, {field, ...}, numbers)`
/// with names and numbers of each member in order.
namespace messages {

/// Names of adjacent numbers.
using Names = std::initializer_list<const char*>;

/// Visit a member that consists of one field of the same name.
template <class Visit, class Number>
void visit_number(const Visit& visit, const char* name, Number& number) {
  visit(name, {name}, &number);
}

/// Pose of the frame in the world and its velocity, with the variance of the noise on each.
struct Odometry {
  static constexpr const char* kind = "odometry";  ///< MessageKind::name
  /// MessageKind::meaning
  static constexpr const char* meaning = "units as in the log; variances in the squared units";
  Vector3d position = Vector3d::Zero();  ///< world axes [m]
  Quaterniond orientation =
      Quaterniond::Identity();  ///< orientation of the frame in the world, unit quaternion
  Vector3d linear_velocity =
      Vector3d::Zero();  ///< velocity of the frame's origin, axes defined by the publisher [m/s]
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

/// Measurement of a GPS receiver: position on Earth and in the world, and velocity.
struct Fix {
  static constexpr const char* kind = "fix";  ///< MessageKind::name
  /// MessageKind::meaning
  static constexpr const char* meaning =
      "degrees, m, m/s, and variances; position and velocity in world axes";
  double latitude = 0;                   ///< positive north [deg]
  double longitude = 0;                  ///< positive east [deg]
  double altitude = 0;                   ///< [m]
  Vector3d position = Vector3d::Zero();  ///< position in world axes [m]
  Vector3d velocity = Vector3d::Zero();  ///< world axes [m/s]
  double horizontal_variance = 0;        ///< variance of each of x and y [m^2]
  double vertical_variance = 0;          ///< variance of z [m^2]
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
  double pressure = 0;  ///< static pressure of the air [Pa]
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
  static constexpr const char* meaning =
      "voltage, V; current, A; remaining charge, A h; full charge, A h";
  double voltage = 0;   ///< terminal voltage [V]
  double current = 0;   ///< discharge current [A]
  double charge = 0;    ///< remaining charge [A h]
  double capacity = 0;  ///< charge of the full battery [A h]

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
  Vector3d position = Vector3d::Zero();      ///< position of the frame's origin [m]
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

/// A force at a point and a torque; the reader defines point and axes.
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

/// A spatial vector; the publisher defines axes and unit.
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

/// Velocity of the air, world axes.
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

/// Velocity of a GPS receiver, world axes.
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

/// Return the kind for the rate of one joint [rad/s].
inline MessageKind motor_speed() { return {"motor_speed", {"w"}, {}, "joint rate, rad/s"}; }

/// Return the kind for the signed speeds of any number of rotors [rad/s], before the division by
/// sim_slow.
inline MessageKind speeds(std::size_t rotors) {
  MessageKind kind{
      "speeds", {}, {}, "rotor speeds, rad/s, signed, before the division by `sim_slow`"};
  for (std::size_t i = 0; i < rotors; ++i) kind.fields.push_back("w" + std::to_string(i + 1));
  return kind;
}

/// Return the members of a message type and the fields of each.
template <class M>
std::vector<std::pair<std::string, std::vector<std::string>>> parts_of() {
  std::vector<std::pair<std::string, std::vector<std::string>>> parts;
  M any;
  M::for_each_field(any, [&parts](const char* part, Names fields, const double*) {
    parts.emplace_back(part, std::vector<std::string>(fields.begin(), fields.end()));
  });
  return parts;
}

/// Return the kind of a message type. `meaning` may be more specific than that of the type.
template <class M>
MessageKind kind_of(const char* meaning = M::meaning) {
  MessageKind kind{M::kind, {}, {}, meaning};
  for (const auto& [part, fields] : parts_of<M>()) {
    kind.fields.insert(kind.fields.end(), fields.begin(), fields.end());
  }
  return kind;
}

/// Write a message as a row of numbers.
template <class M>
void write(const M& message, double* row) {
  M::for_each_field(message, [&row](const char*, Names fields, const double* values) {
    row = std::copy_n(values, fields.size(), row);
  });
}

/// Return the message in a row of numbers.
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
