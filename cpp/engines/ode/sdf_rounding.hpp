#pragma once

#include "quadcore/model.hpp"

namespace quadcore {

/// The model after Gazebo 11's conversion from URDF to SDF, which prints every scalar with 6
/// significant digits and every component of a pose or axis first to 6 decimals. Measured against
/// Gazebo 11.1; unrounded values put a flight of 10 s up to 1e-4 m off its recording. Throws
/// InputError if the rounding leaves an inertia or an axis without meaning.
Model rounded_like_sdf(Model model);

}  // namespace quadcore
