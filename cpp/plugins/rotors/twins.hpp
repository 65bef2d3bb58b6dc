#pragma once

#include <string>

#include "naming.hpp"
#include "quadcore/plugin.hpp"

namespace quadcore::rotors {

/// Warn if an earlier motor has the same number.
inline void look_at_twins(const PluginSetup& setup) {
  const auto of = [](const PluginElement& plugin, const std::string& name) {
    for (const PluginTag& tag : plugin.tags) {
      if (tag.name == name) return tag;
    }
    return PluginTag{};
  };
  for (const PluginElement& other : setup.model.plugins) {
    if (other.name == setup.name) return;
    if (other.filename != motor_model_file) continue;
    const PluginTag number = of(other, "motorNumber");
    if (number.text == setup.parameters.text("motorNumber")) {
      setup.warnings.push_back(
          "motors '" + other.name + "' and '" + setup.name + "' have the same <motorNumber> " +
          number.text + " (" + number.where +
          "), so one number of the command drives both. Give each motor its own number.");
    }
  }
}

}  // namespace quadcore::rotors
