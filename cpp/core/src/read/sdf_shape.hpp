#pragma once

#include <optional>

#include "embedded_meshes.hpp"
#include "sdf_models.hpp"

namespace quadcore {

/// Read a `<collision>` without its pose and names. Empty if nothing collides with it, or if it is
/// recorded as not simulated: a heightmap, or a mesh without file. Throws InputError for another
/// shape that is not supported.
/// \param model  name of its model
/// \param scale  scale of the model's shapes
/// \param meshes  triangles of the collision's document
std::optional<Obstacle> read_obstacle(const Xml& xml, const Xml::Element& collision,
                                      const std::string& model, const Vector3d& scale,
                                      bool is_static, EmbeddedMeshes& meshes);

}  // namespace quadcore
