#pragma once

#include <map>
#include <string>

#include "quadcore/plugin/model.hpp"

namespace quadcore::node {

/// Keeps one drag of the thesis active: every other plugin tag of the form NAMEDragCoeff becomes 0.
/// \param drag        name of a drag, "none", or "all": no change
/// \param parameters  "PLUGIN.TAG" -> value, as in SimulationOptions; extended
/// Throws InputError if the model has no such drag, or if `parameters` already contains a tag.
void choose_drag(const std::string& drag, const Model& model,
                 std::map<std::string, std::string>& parameters);

}  // namespace quadcore::node
