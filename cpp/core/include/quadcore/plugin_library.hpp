#pragma once

#include <string>
#include <vector>

#include "quadcore/plugin.hpp"

namespace quadcore {

/// A loaded module. Modules stay loaded until the process ends: objects they made may live on.
struct PluginLibrary {
  std::string path;
  const PluginDescriptor* descriptor;
};

/// Adds a folder to search before the others. Throws InputError if it is not a folder.
void load_plugin_path(const std::string& folder);

/// The folders in the order they are searched: those of load_plugin_path (newest first), those of
/// QUADCORE_PLUGIN_PATH, the one this library lies in.
std::vector<std::string> plugin_folders();

/// Finds and loads the module of a plugin tag. Throws InputError naming the tag, the file and what
/// is wrong with it (not found: every folder that was searched).
PluginLibrary open_plugin(const PluginElement& element);

}  // namespace quadcore
