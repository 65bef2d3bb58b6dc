#pragma once

#include <string_view>

#include "quadcore/plugin/model.hpp"

namespace quadcore {

/// A body that rides on the frame, held as a URDF's fixed joint would hold it. It has no shape.
struct CarriedBody {
  std::string_view name;  ///< as of a link; the text is a member of the plugin
  Pose pose;              ///< of the body in the frame
  Inertial inertial;      ///< in the body's own axes
};

}  // namespace quadcore
