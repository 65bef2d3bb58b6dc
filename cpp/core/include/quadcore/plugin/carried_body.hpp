#pragma once

#include <string_view>

#include "quadcore/plugin/model.hpp"

namespace quadcore {

/// A body that is attached to the frame as if by a fixed joint of a URDF. It has no collision
/// shape.
struct CarriedBody {
  std::string_view name;  ///< unique, like that of a link; the text must be a member of the plugin
  Pose pose;              ///< pose of the body in the frame
  Inertial inertial;      ///< mass and inertia in the body's axes
};

}  // namespace quadcore
