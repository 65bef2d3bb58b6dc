#include "topic_broadcast.hpp"

namespace quadcore::node {

TopicBroadcast::TopicBroadcast(ros::NodeHandle& nh, const Simulation& simulation,
                               const std::string& vehicle_frame, const std::string& but) {
  const Topics& topics = simulation.topics();
  for (const std::string& name : topics.names()) {
    const std::size_t index = topics.at(name);
    if (name == but || topics[index].writer == the_caller) continue;
    topics_.push_back({index, make_outlet(nh, topics[index], vehicle_frame)});
  }
}

void TopicBroadcast::send(const Simulation& simulation, const ros::Time& stamp, bool jumped) {
  for (Sent& sent : topics_) {
    const Topic& topic = simulation.topics()[sent.topic];
    if (topic.count == 0 || (topic.count == sent.count && !jumped)) continue;
    sent.count = topic.count;
    sent.outlet->send(topic, stamp);
  }
}

}  // namespace quadcore::node
