#pragma once

#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Tag of `<gazebo reference="LINK or JOINT">`, used for parsing, errors and the docs.
struct GazeboTag {
  std::string name;      ///< name of the element
  std::string of;        ///< kind of element that the reference must name: link | joint
  std::string affects;   ///< shapes | body | joint; "" = nothing
  std::string unit;      ///< "" = none
  std::string fallback;  ///< default value, "" = none
  std::string range;     ///< range as text
  std::string meaning;   ///< one line
};

/// Return all tags, those with an effect first.
std::vector<GazeboTag> gazebo_tags();

/// A tag with an effect and its value; a number or a flag (0 or 1) is the first component.
struct GivenTag {
  std::string name;   ///< name of the element
  Vector3d value;     ///< value in the unit of GazeboTag
  std::string where;  ///< FILE:LINE
};

/// One `<gazebo reference="...">` with its tags that have an effect.
struct GazeboReference {
  std::string name;            ///< name of a link or a joint
  std::string where;           ///< FILE:LINE
  std::vector<GivenTag> tags;  ///< in the order of the file
};

}  // namespace quadcore
