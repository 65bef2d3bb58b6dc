#pragma once

#include "quadcore/urdf_tree.hpp"
#include "xml.hpp"

namespace quadcore {

/// Reads one <gazebo reference="...">, each tag checked by itself.
GazeboReference read_reference(const Xml& xml, const Xml::Element& element);

/// Gives what the references say to the tree's links, shapes and joints, by Gazebo's rules: a body
/// has gravity as its last reference says and damping as its first does, those of the links fixed
/// to it included; a shape feels the tags of its own link, which Gazebo finds by the shape's name.
/// Throws InputError where a felt tag names nothing that feels it. The topology has been checked.
void apply_references(UrdfTree& tree);

}  // namespace quadcore
