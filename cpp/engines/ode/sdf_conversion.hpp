#pragma once

#include "bodies.hpp"
#include "quadcore/urdf_tree.hpp"

namespace quadcore {

/// Return the model after Gazebo 11's conversion from URDF to SDF, which lumps fixed links in its
/// own way and prints every number (sdf_lumping.hpp, sdf_numbers.hpp). It was verified against
/// Gazebo 11.1; with unrounded values, a flight of 10 s deviates by up to 1e-4 m from the
/// recording. A link behind a locked joint, which Gazebo keeps, is rounded separately and lumped
/// afterwards. Throws InputError if Gazebo drops a rotor, or if the rounding makes an inertia or an
/// axis invalid.
Model converted_to_sdf(const Model& model);

/// Return Gazebo's bodies of the model, each on its joint: those of converted_to_sdf(), but with
/// the links behind locked joints as separate bodies. The rotors keep their order. The warnings of
/// their model name the links that remain lumped.
Bodies sdf_bodies(const Model& model);

/// Return the indices of the model's bodies in the order of their creation in Gazebo.
std::vector<std::size_t> sdf_order(const Model& model);

}  // namespace quadcore
