#pragma once

#include "quadcore/urdf_tree.hpp"
#include "xml.hpp"

namespace quadcore {

/// Read one <gazebo reference="..."> and check each tag individually.
GazeboReference read_reference(const Xml& xml, const Xml::Element& element);

/// Apply the references to the tree's links, shapes and joints by Gazebo's rules. The last
/// reference of a body, including those of the links fixed to it, sets its gravity; the first one
/// sets its damping. A shape takes the tags of its own link, which Gazebo finds by the shape's
/// name. Throws InputError if a tag with an effect names no link or joint that it applies to.
/// Requires a checked topology.
void apply_references(UrdfTree& tree);

}  // namespace quadcore
