#pragma once

#include <optional>

#include "sdf_models.hpp"

namespace quadcore {

/// Read a `<collision>` without its pose and names. Empty if nothing collides with it.
/// \param scale  scale of the model's shapes
std::optional<StaticShape> read_static_shape(const Xml& xml, const Xml::Element& collision,
                                             const Vector3d& scale);

}  // namespace quadcore
