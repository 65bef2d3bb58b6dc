#include "odometry_topic.hpp"

namespace quadcore::node {

OdometryTopic::OdometryTopic(const Simulation& simulation) {
  const int index = simulation.topics().find(name);
  if (index < 0) return;
  const Topic& topic = simulation.topics()[static_cast<std::size_t>(index)];
  if (topic.writer == the_caller || !(topic.kind == messages::kind_of<messages::Odometry>()))
    return;
  index_ = index;
  const LoadedPlugin& writer = simulation.plugins()[static_cast<std::size_t>(topic.writer)];
  for (const Parameter& parameter : writer.parameters.all()) {
    publishes_tf_ |= parameter.spec.name == "publishTf" && parameter.text == "true";
  }
  twist_in_body_ = simulation.has_velocity_in_body();
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
