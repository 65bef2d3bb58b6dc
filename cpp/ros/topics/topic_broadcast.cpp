#include "topic_broadcast.hpp"

#include <algorithm>
#include <utility>

#include "messages.hpp"
#include "plant.hpp"
#include "rotors_types.hpp"

namespace quadcore::node {
namespace {

/// Returns the tf frame of a plugin's messages: that of a RotorS tag, its link, or the vehicle if
/// it has no link.
std::string make_frame_name(const LoadedPlugin& plugin, const std::string& prefix) {
  const std::vector<Parameter>& all = plugin.parameters.all();
  for (const char* tag : {"childFrameId", "frameId"}) {
    for (const Parameter& parameter : all) {
      if (parameter.spec.name == tag && !parameter.text.empty()) return parameter.text;
    }
  }
  const auto link = std::find_if(all.begin(), all.end(),
                                 [](const Parameter& p) { return p.spec.kind == TagKind::link; });
  return link == all.end() ? prefix + vehicle_name : node::make_frame_name(prefix, link->text);
}

}  // namespace

TopicBroadcast::TopicBroadcast(ros::NodeHandle& nh, const Simulation& simulation,
                               const std::string& frame_prefix, const std::string& but) {
  const Topics& topics = simulation.topics();
  const std::string root_frame =
      node::make_frame_name(frame_prefix, simulation.model().links.front().name);
  for (const std::string& name : topics.names()) {
    const std::size_t index = topics.at(name);
    if (name == but || topics[index].writer == the_caller) continue;
    const LoadedPlugin& writer =
        simulation.plugins()[static_cast<std::size_t>(topics[index].writer)];
    check_name_is_free(nh, topics[index].path);
    const std::string frame = make_frame_name(writer, frame_prefix);
    auto outlet = make_rotors_outlet(nh, topics[index], writer, frame, root_frame);
    if (!outlet) outlet = make_outlet(nh, topics[index], frame);
    topics_.push_back({index, std::move(outlet)});
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
