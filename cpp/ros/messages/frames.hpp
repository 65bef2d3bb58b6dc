#pragma once

#include <string>

/// \file
/// Names of tf frames.

namespace quadcore::node {

/// The tf frames of a vehicle.
struct Frames {
  std::string prefix;             ///< prefix of links: "uav1/" in the namespace uav1
  std::string map;                ///< parent of `world`, at the same place; "" = none
  std::string world = "world";    ///< frame of positions
  std::string vehicle = "drone";  ///< frame of the vehicle; by default the thesis' name

  /// Returns the frame of a link. The names of RotorS' links already contain the namespace.
  std::string of_link(const std::string& link) const {
    return link.rfind(prefix, 0) == 0 ? link : prefix + link;
  }
};

/// The frames of a message: that of its numbers, and the parent of a pose or a velocity.
struct MessageFrames {
  std::string parent, own;
};

}  // namespace quadcore::node
