#pragma once

#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"

/// \file
/// Models made for Gazebo hold more than flies. What is only seen or sensed is passed over with a
/// warning, what is felt and cannot be honoured is refused, and what is foreign is refused unless
/// the user asks to leave it out.

namespace quadcore QUADCORE_EXPORT {

/// What becomes of something that a reader does not read.
enum class Verdict {
  unfelt,   ///< looks, sensors, notes for other programs: passed over, with a warning
  felt,     ///< would change the motion: refused
  foreign,  ///< of unknown effect: refused, unless the user asks to leave it out
};

/// An element or a module that no vehicle feels.
struct Unfelt {
  std::string name;    ///< of the element, or file name of the module
  std::string parent;  ///< the element around it, as below; "" for a module
  std::string what;    ///< it is
};

/// Every known one, elements first: for documentation.
const std::vector<Unfelt>& everything_unfelt();

/// What becomes of an element that its parent's reader does not know.
/// \param parent  the document's root and the element around it: "robot/link", "sdf/world"; or the
///                root alone.
Verdict verdict_on_element(const std::string& parent, const std::string& element);
/// What becomes of a plugin tag whose module quadcore does not have: `unfelt` if the module is
/// known to sense or to publish only. One that pushes or controls is foreign.
Verdict verdict_on_module(const std::string& filename);
/// What becomes of text between the elements in `parent`.
Verdict verdict_on_text(const std::string& parent);

}  // namespace quadcore
