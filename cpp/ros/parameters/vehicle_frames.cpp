#include "vehicle_frames.hpp"

#include <algorithm>

#include "odometry_topic.hpp"
#include "private_parameters.hpp"
#include "quadcore/urdf_tree.hpp"

namespace quadcore::node {
namespace {

std::string find_text(const LoadedPlugin& plugin, const std::string& tag) {
  for (const Parameter& parameter : plugin.parameters.all()) {
    if (parameter.spec.name == tag) return parameter.text;
  }
  return "";
}

void replace_if_given(std::string& name, const std::string& given) {
  if (!given.empty()) name = given;
}

void check_name(const char* parameter, const std::string& name) {
  const auto is_separator = [](char c) { return c == ' ' || c == '\t' || c == '\n'; };
  if (name.front() == '/' || std::any_of(name.begin(), name.end(), is_separator)) {
    refuse_parameter(parameter,
                     "a name without blanks that does not begin with a slash, not '" + name + "'");
  }
}

/// tf is a tree, so each frame has one parent.
void check_frames(const Frames& frames, const Model& model) {
  const char* const vehicle = "vehicle_frame";
  if (!frames.map.empty()) check_name("map_frame", frames.map);
  check_name("world_frame", frames.world);
  check_name(vehicle, frames.vehicle);
  if (frames.world == frames.map) refuse_parameter("world_frame", "another name than map_frame");
  if (frames.vehicle == frames.world || frames.vehicle == frames.map) {
    refuse_parameter(vehicle, "another name than that of its parents");
  }
  const std::string& root = model.links.front().name;
  for (const UrdfLink& link : model.urdf->links) {
    const std::string name = frames.of_link(link.name);
    const std::string other = "another name than that of link '" + link.name + "'";
    if (name == frames.map) refuse_parameter("map_frame", other);
    if (name == frames.world) refuse_parameter("world_frame", other);
    if (name == frames.vehicle && link.name != root) refuse_parameter(vehicle, other);
  }
}

}  // namespace

MessageFrames read_frame_tags(const LoadedPlugin& plugin, MessageFrames frames,
                              const Frames& of_vehicle) {
  replace_if_given(frames.parent, find_text(plugin, "frame_id"));
  const std::string own = find_text(plugin, "child_frame_id");
  if (!own.empty()) frames.own = of_vehicle.of_link(own);
  return frames;
}

Frames choose_frames(const ros::NodeHandle& nh, const FrameNames& given,
                     const Simulation& simulation) {
  Frames frames;
  frames.prefix = nh.getNamespace().substr(1);
  if (!frames.prefix.empty()) frames.prefix += '/';
  const OdometryTopic odometry(simulation);
  if (odometry.exists()) {
    const int writer = odometry.in(simulation).writer;
    const LoadedPlugin& plugin = simulation.plugins()[static_cast<std::size_t>(writer)];
    replace_if_given(frames.world, find_text(plugin, "frame_id"));
    replace_if_given(frames.vehicle, find_text(plugin, "child_frame_id"));
  }
  frames.map = given.map;
  replace_if_given(frames.world, given.world);
  replace_if_given(frames.vehicle, given.vehicle);
  if (!frames.map.empty()) frames.world = frames.of_link(frames.world);
  frames.vehicle = frames.of_link(frames.vehicle);
  check_frames(frames, simulation.model());
  return frames;
}

}  // namespace quadcore::node
