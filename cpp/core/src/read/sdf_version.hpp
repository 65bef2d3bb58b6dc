#pragma once

#include "xml.hpp"

namespace quadcore {

/// Return whether the nearest `<sdf>` around an element has at most the version 1.`minor`. A file
/// without version, which Gazebo refuses, counts as old.
bool is_at_most_sdf(const Xml& xml, const Xml::Element& element, int minor);

}  // namespace quadcore
