#pragma once

#include <ros/ros.h>

#include <string>

#include "frames.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// Names of frames as parameters; "" = not given.
struct FrameNames {
  std::string map, world, vehicle;
};

/// Returns the frames of a message with those of the tags frame_id and child_frame_id of its
/// plugin.
/// \param frames  without tags
MessageFrames read_frame_tags(const LoadedPlugin& plugin, MessageFrames frames,
                              const Frames& of_vehicle);

/// Chooses the frames of a vehicle: those of the parameters, else of the tags of the plugin that
/// publishes odom, else the thesis' names. In a namespace, the vehicle's frame gets a prefix. The
/// frame of positions gets it below a map, because it is then that of one vehicle (REP 105).
/// Throws InputError if a name is not valid.
Frames choose_frames(const ros::NodeHandle& nh, const FrameNames& given,
                     const Simulation& simulation);

}  // namespace quadcore::node
