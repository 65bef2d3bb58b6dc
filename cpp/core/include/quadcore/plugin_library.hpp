#pragma once

#include <optional>
#include <string>
#include <vector>

#include "quadcore/plugin.hpp"
#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// A loaded module. Modules remain loaded until the process ends, because their objects may live
/// on.
struct PluginLibrary {
  std::string path;  ///< path, or only the file name for a plugin in a static core
  const PluginDescriptor* descriptor;  ///< description of the plugin
};

/// Add a folder that is searched before the others. Throws InputError if it is not a folder.
void load_plugin_path(const std::string& folder);

/// Return the folders in the order of the search: those of load_plugin_path() (newest first), those
/// of QUADCORE_PLUGIN_PATH, and the folder of a shared core. The built-in plugins of a static core
/// come last.
std::vector<std::string> plugin_folders();

/// Return whether this is a quadcore module with the name of a RotorS module.
bool is_named_as_others(const std::string& path);

/// Return the path of a module in the first folder that contains it, or the name of a built-in
/// module.
/// \param filename  file name of the plugin tag, without folder.
std::optional<std::string> find_plugin(const std::string& filename);

/// Load the module of a plugin tag from the path of find_plugin(). Throws InputError with the tag,
/// the file and the problem.
PluginLibrary open_plugin(const PluginElement& element, const std::string& path);

/// Return the error for a missing module: the searched folders, a similar file name, and how to
/// ignore it.
std::string describe_missing(const PluginElement& element);

}  // namespace quadcore
