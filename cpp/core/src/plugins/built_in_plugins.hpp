#pragma once

#include <map>
#include <string>

namespace quadcore {

struct PluginModule;

/// The plugins linked into a static core, by the file names of their modules; empty in a shared
/// core. The build generates this table.
const std::map<std::string, const PluginModule*>& built_in_plugins();

}  // namespace quadcore
