#pragma once

#include <vector>

#include "quadcore/plugin/carried_body.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore {

bool operator==(const CarriedBody& a, const CarriedBody& b);

/// Throws Error on a body that no link could be, or that has the name of a link or of a body before
/// it in the list.
void check_carried(const std::vector<CarriedBody>& bodies, std::size_t i, const Model& model);

/// The model with a link on a fixed joint, both of the body's name, for each of the bodies, the
/// last of its URDF. Every engine lumps them as it does those that the URDF itself has there.
Model with_carried(const Model& model, const std::vector<CarriedBody>& bodies);

}  // namespace quadcore
