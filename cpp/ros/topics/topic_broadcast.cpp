#include "topic_broadcast.hpp"

#include <algorithm>
#include <utility>

#include "messages.hpp"
#include "rotors_types.hpp"
#include "vehicle_frames.hpp"

namespace quadcore::node {
namespace {

/// Returns the frame of a plugin's messages: that of a RotorS tag, its link, or the vehicle if it
/// has no link.
std::string choose_own_frame(const LoadedPlugin& plugin, const Frames& frames) {
  const std::vector<Parameter>& all = plugin.parameters.all();
  for (const char* tag : {"childFrameId", "frameId"}) {
    for (const Parameter& parameter : all) {
      if (parameter.spec.name == tag && !parameter.text.empty()) return parameter.text;
    }
  }
  const auto link = std::find_if(all.begin(), all.end(),
                                 [](const Parameter& p) { return p.spec.kind == TagKind::link; });
  return link == all.end() ? frames.vehicle : frames.of_link(link->text);
}

}  // namespace

TopicBroadcast::TopicBroadcast(ros::NodeHandle& nh, const Simulation& simulation,
                               const Frames& frames, const std::string& but) {
  const Topics& topics = simulation.topics();
  const std::string root_frame = frames.of_link(simulation.model().links.front().name);
  for (const std::string& name : topics.names()) {
    const std::size_t index = topics.at(name);
    if (name == but || topics[index].writer == the_caller) continue;
    const LoadedPlugin& writer =
        simulation.plugins()[static_cast<std::size_t>(topics[index].writer)];
    check_name_is_free(nh, topics[index].path);
    const MessageFrames own =
        read_frame_tags(writer, {frames.world, choose_own_frame(writer, frames)}, frames);
    auto outlet = make_rotors_outlet(nh, topics[index], writer, own, root_frame);
    if (!outlet) outlet = make_outlet(nh, topics[index], own);
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
