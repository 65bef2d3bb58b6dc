#pragma once

#include <map>
#include <string>

#include "quadcore/plugin/model.hpp"

namespace quadcore::node {

/// Leaves one of the effects that drag at work, as the thesis switches them: each other plugin tag
/// of the form EFFECTDragCoeff becomes 0.
/// \param drag        an effect, "none", or "all": as the model has it
/// \param parameters  "PLUGIN.TAG" -> value, as SimulationOptions has them; added to
/// Throws InputError if the model has no such effect or a tag is in `parameters` already.
void choose_drag(const std::string& drag, const Model& model,
                 std::map<std::string, std::string>& parameters);

}  // namespace quadcore::node
