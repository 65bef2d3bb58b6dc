#pragma once

#include "bodies.hpp"
#include "quadcore/urdf_tree.hpp"

namespace quadcore {

/// The model after Gazebo 11's conversion from URDF to SDF, which lumps fixed links in its own way
/// and prints every number (sdf_lumping.hpp, sdf_numbers.hpp). Measured against Gazebo 11.1;
/// unrounded values put a flight of 10 s up to 1e-4 m off its recording. A link behind a locked
/// joint, which Gazebo keeps, is rounded by itself and lumped afterwards: this is what users see.
/// Throws InputError where Gazebo loses a rotor, or where the rounding leaves an inertia or an axis
/// without meaning.
Model converted_to_sdf(const Model& model);

/// The bodies that Gazebo makes of the model, each on its joint: those of converted_to_sdf(), but
/// with the links behind locked joints as bodies of their own. The rotors keep their order. The
/// warnings of their model name the links that stay lumped.
Bodies sdf_bodies(const Model& model);

/// Indices of the model's bodies in the order in which Gazebo makes them.
std::vector<std::size_t> sdf_order(const Model& model);

}  // namespace quadcore
