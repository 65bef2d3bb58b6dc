#pragma once

#include <vector>

#include "quadcore/plugin/carried_body.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore {

bool operator==(const CarriedBody& a, const CarriedBody& b);

/// Throw Error if a body is invalid as a link, or has the name of a link or of an earlier body.
void check_carried(const std::vector<CarriedBody>& bodies, std::size_t i, const Model& model);

/// Return the model with one more link on a fixed joint for each body, both named after the body
/// and appended to the URDF. Every engine lumps them like links of the URDF itself.
Model with_carried(const Model& model, const std::vector<CarriedBody>& bodies);

}  // namespace quadcore
