#pragma once

#include <ode/ode.h>

#include <memory>

#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/obstacle.hpp"

namespace quadcore {

struct DestroyGeom {
  void operator()(dxGeom* geom) const;
};
using Geom = std::unique_ptr<dxGeom, DestroyGeom>;

/// Return the geom of a vehicle's shape. Throws InputError for one without contact model (a mesh).
Geom create_shape(const Collision& collision);

/// Return the geom of an obstacle at its place. Its mesh must outlive the geom.
Geom create_solid(const Obstacle& obstacle);

}  // namespace quadcore
