#pragma once

#include <optional>
#include <string>
#include <vector>

#include "quadcore/plugin.hpp"
#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// A loaded module. Modules stay loaded until the process ends: objects they made may live on.
struct PluginLibrary {
  std::string path;  ///< of a plugin that a static core has inside: the file name alone
  const PluginDescriptor* descriptor;  ///< what it says of itself
};

/// Adds a folder to search before the others. Throws InputError if it is not a folder.
void load_plugin_path(const std::string& folder);

/// The folders in the order they are searched: those of load_plugin_path (newest first), those of
/// QUADCORE_PLUGIN_PATH, and of a shared core the one it lies in. A static core has the shipped
/// plugins inside, where they are looked for last.
std::vector<std::string> plugin_folders();

/// Whether this is a shipped module that has the name of one of another program's.
bool is_named_as_others(const std::string& path);

/// The path of a module in the first of the folders that holds it; of one that is built in, its
/// name alone.
/// \param filename  of a plugin tag, without folder.
std::optional<std::string> find_plugin(const std::string& filename);

/// Loads the module of a plugin tag from where find_plugin() found it. Throws InputError naming the
/// tag, the file and what is wrong with it.
PluginLibrary open_plugin(const PluginElement& element, const std::string& path);

/// Why a plugin tag's module, which is not there, is refused: the folders that were searched, the
/// nearest file in them, and how to fly without it.
std::string describe_missing(const PluginElement& element);

}  // namespace quadcore
