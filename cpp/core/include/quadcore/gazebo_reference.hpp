#pragma once

#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore QUADCORE_EXPORT {

/// What a `<gazebo reference="LINK or JOINT">` may hold. Parsing, errors and the docs come from
/// here.
struct GazeboTag {
  std::string name;      ///< of the element
  std::string of;        ///< what the reference must name: link | joint
  std::string felt_by;   ///< shapes | body | joint; "" = nothing
  std::string unit;      ///< "" = none
  std::string fallback;  ///< the default, "" = none
  std::string range;     ///< as a person reads it
  std::string meaning;   ///< one line
};

/// All of them, the felt ones first.
std::vector<GazeboTag> gazebo_tags();

/// A felt tag with its value; a number or a flag (0 or 1) is the first component.
struct GivenTag {
  std::string name;   ///< of the element
  Vector3d value;     ///< in the unit that GazeboTag tells
  std::string where;  ///< FILE:LINE
};

/// One `<gazebo reference="...">`, with the tags that are felt.
struct GazeboReference {
  std::string name;            ///< of a link or a joint
  std::string where;           ///< FILE:LINE
  std::vector<GivenTag> tags;  ///< in the order of the file
};

}  // namespace quadcore
