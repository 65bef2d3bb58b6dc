#include "odometry_topic.hpp"

#include <algorithm>

#include "messages.hpp"
#include "quadcore/error.hpp"

namespace quadcore::node {
namespace {

/// Fields of the topic in the order of a message.
constexpr std::array<const char*, 17> fields = {"x",
                                                "y",
                                                "z",
                                                "qx",
                                                "qy",
                                                "qz",
                                                "qw",
                                                "vx",
                                                "vy",
                                                "vz",
                                                "wx",
                                                "wy",
                                                "wz",
                                                "position_variance",
                                                "orientation_variance",
                                                "linear_velocity_variance",
                                                "angular_velocity_variance"};

/// A variance of zero stands for "unknown" to some filters and is singular to others. Without
/// noise this is sent: a deviation of 1e-6.
constexpr double least_variance = 1e-12;

/// A diagonal 6x6 covariance: three variances of translation, three of rotation.
template <class Matrix>
void set_covariance(Matrix& matrix, double translation, double rotation) {
  for (std::size_t i = 0; i < 6; ++i) {
    matrix[7 * i] = std::max(i < 3 ? translation : rotation, least_variance);
  }
}

/// Fills a message from its 17 numbers.
void fill(const double* values, nav_msgs::Odometry& message) {
  set_vector(message.pose.pose.position, values);
  set_quaternion(message.pose.pose.orientation, values + 3);
  set_vector(message.twist.twist.linear, values + 7);
  set_vector(message.twist.twist.angular, values + 10);
  set_covariance(message.pose.covariance, values[13], values[14]);
  set_covariance(message.twist.covariance, values[15], values[16]);
}

/// What a plugin's tag says; "" if it has no such tag.
std::string tag(const LoadedPlugin& plugin, const std::string& name) {
  for (const Parameter& parameter : plugin.parameters.all()) {
    if (parameter.spec.name == name) return parameter.text;
  }
  return "";
}

}  // namespace

OdometryTopic::OdometryTopic(const Simulation& simulation)
    : index_(simulation.topics().find("odom")) {
  if (!exists()) return;
  const Topic& topic = in(simulation);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto field = std::find(topic.fields.begin(), topic.fields.end(), fields[i]);
    if (field == topic.fields.end()) {
      throw InputError(std::string("topic 'odom' has no field '") + fields[i] +
                       "'; nav_msgs/Odometry needs it");
    }
    columns_[i] = static_cast<std::size_t>(field - topic.fields.begin());
  }
  if (topic.writer < 0) return;
  const LoadedPlugin& writer = simulation.plugins()[static_cast<std::size_t>(topic.writer)];
  publishes_tf_ = tag(writer, "publishTf") == "true";
  twist_in_body_ = tag(writer, "twistFrame") == "body";
}

void OdometryTopic::to_message(const Topic& topic, nav_msgs::Odometry& message) const {
  std::array<double, fields.size()> values;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = topic.values[columns_[i]];
  fill(values.data(), message);
}

void OdometryTopic::truth_to_message(const VehicleState& state, nav_msgs::Odometry& message) const {
  const Vector3d linear = twist_in_body_ ? state.orientation.conjugate() * state.linear_velocity
                                         : state.linear_velocity;
  std::array<double, fields.size()> values{};
  Eigen::Map<Vector3d>(values.data()) = state.position;
  Eigen::Map<Eigen::Vector4d>(values.data() + 3) = state.orientation.coeffs();
  Eigen::Map<Vector3d>(values.data() + 7) = linear;
  Eigen::Map<Vector3d>(values.data() + 10) = state.angular_velocity;
  fill(values.data(), message);
}

}  // namespace quadcore::node
