#include "odometry_topic.hpp"

#include <string>

namespace quadcore::node {
namespace {

/// What a plugin's tag says; "" if it has no such tag.
std::string tag(const LoadedPlugin& plugin, const std::string& name) {
  for (const Parameter& parameter : plugin.parameters.all()) {
    if (parameter.spec.name == name) return parameter.text;
  }
  return "";
}

}  // namespace

OdometryTopic::OdometryTopic(const Simulation& simulation) {
  const int index = simulation.topics().find(name);
  if (index < 0) return;
  const Topic& topic = simulation.topics()[static_cast<std::size_t>(index)];
  if (topic.writer == the_caller || !(topic.kind == messages::kind_of<messages::Odometry>()))
    return;
  index_ = index;
  const LoadedPlugin& writer = simulation.plugins()[static_cast<std::size_t>(topic.writer)];
  publishes_tf_ = tag(writer, "publishTf") == "true";
  twist_in_body_ = tag(writer, "twistFrame") == "body";
}

messages::Odometry OdometryTopic::truth(const VehicleState& state) const {
  messages::Odometry odometry;
  odometry.position = state.position;
  odometry.orientation = state.orientation;
  odometry.linear_velocity = twist_in_body_ ? state.orientation.conjugate() * state.linear_velocity
                                            : state.linear_velocity;
  odometry.angular_velocity = state.angular_velocity;
  return odometry;
}

}  // namespace quadcore::node
