#pragma once

#include <string>
#include <vector>

#include "quadcore/plugin/document.hpp"

namespace quadcore {

/// Return a world that needs no other file: it contains the SDF of each included model inside the
/// first `<include>` of its URI, and the triangles of each mesh that collides inside its first
/// `<mesh>`. An `<include>` whose model is not found stays as it is. Without
/// included files, the result is the world itself.
/// \param ignore  URIs that are not read
/// Throws InputError if a model's or mesh's file is malformed, or a model includes itself.
Document embed_models(const Document& world, const std::vector<std::string>& ignore);

/// Return the SDF of a model that is part of Gazebo, such as `model://ground_plane`, or "".
std::string find_builtin_model(const std::string& uri);

}  // namespace quadcore
