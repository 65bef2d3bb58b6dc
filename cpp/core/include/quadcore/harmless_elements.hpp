#pragma once

#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"

/// \file
/// Models made for Gazebo contain elements that quadcore does not model. Elements that are only
/// seen or sensed are skipped with a warning. Elements that would change the motion are rejected.
/// Unknown elements of a model are rejected unless the user ignores them. Those of a world (SDF)
/// are skipped, as Gazebo skips them, unless their name resembles a known one.

namespace quadcore QUADCORE_EXPORT {

/// How a reader handles something that it does not read.
enum class Handling {
  skip,                   ///< appearance, sensors, data for other programs: skip with a warning
  reject,                 ///< would change the motion: an error
  reject_unless_ignored,  ///< of unknown effect: an error unless the user ignores it
};

/// An element or a module without effect on the motion.
struct HarmlessElement {
  std::string name;    ///< name of the element, or file name of the module
  std::string parent;  ///< path of the parent element, see decide_on_element(); "" for a module
  std::string what;    ///< purpose of the element, or output of the module
};

/// Return all known elements and modules without effect, elements first, for documentation.
const std::vector<HarmlessElement>& list_harmless_elements();

/// Return how to handle an element that its parent's reader does not know.
/// \param parent  the document's root and the parent element: "robot/link", "sdf/world"; or the
/// root
///                alone.
/// \param is_similar  whether the element's name resembles one that the reader knows.
Handling decide_on_element(const std::string& parent, const std::string& element, bool is_similar);
/// Return how to handle a plugin tag without a quadcore module: `skip` if the module is known only
/// to sense or publish. A module that pushes or controls must not be skipped silently.
Handling decide_on_module(const std::string& filename);
/// Return whether a plugin of a Gazebo world is known to move the air around the vehicles.
bool moves_air(const std::string& filename);
/// Return how to handle text between the elements in `parent`.
Handling decide_on_text(const std::string& parent);
/// Return how to handle an attribute of `parent` without a meaning, and a second element in
/// `parent` where only the first has one.
Handling decide_on_excess(const std::string& parent);

}  // namespace quadcore
