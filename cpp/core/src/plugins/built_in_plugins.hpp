#pragma once

#include <map>
#include <string>

#include "quadcore/plugin.hpp"

namespace quadcore {

/// The plugins that a static core has inside, by the file names they have elsewhere; none in a
/// shared core. Made by the build.
const std::map<std::string, const PluginModule*>& built_in_plugins();

}  // namespace quadcore
