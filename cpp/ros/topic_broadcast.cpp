#include "topic_broadcast.hpp"

#include <algorithm>

#include "messages.hpp"

namespace quadcore::node {
namespace {

/// tf's name of the link that a plugin is mounted on, or of the vehicle if it is on none.
std::string frame_of(const LoadedPlugin& plugin, const std::string& prefix) {
  const std::vector<Parameter>& all = plugin.parameters.all();
  const auto link = std::find_if(all.begin(), all.end(),
                                 [](const Parameter& p) { return p.spec.kind == TagKind::link; });
  return prefix + (link == all.end() ? vehicle_name : link->text);
}

}  // namespace

TopicBroadcast::TopicBroadcast(ros::NodeHandle& nh, const Simulation& simulation,
                               const std::string& frame_prefix, const std::string& but) {
  const Topics& topics = simulation.topics();
  for (const std::string& name : topics.names()) {
    const std::size_t index = topics.at(name);
    if (name == but || topics[index].writer == the_caller) continue;
    const LoadedPlugin& writer =
        simulation.plugins()[static_cast<std::size_t>(topics[index].writer)];
    topics_.push_back({index, make_outlet(nh, topics[index], frame_of(writer, frame_prefix))});
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
