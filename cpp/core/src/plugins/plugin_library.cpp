#include "quadcore/plugin_library.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <sstream>

#include "built_in_plugins.hpp"
#include "quadcore/law_interface.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

std::mutex added_mutex;
std::vector<std::string> added_folders;

/// Return the folder of the core library at the time it was loaded.
const std::string& own_folder() {
  static const std::string folder = [] {
    Dl_info info;
    if (!dladdr(reinterpret_cast<const void*>(&own_folder), &info)) return std::string(".");
    return std::filesystem::canonical(info.dli_fname).parent_path().string();
  }();
  return folder;
}

std::string who_is(const PluginElement& element) {
  return element.where + ": plugin '" + element.name + "': " + element.filename;
}

/// Return the plugin folders, then their `quadcore` subfolders. These contain the modules named
/// like RotorS' modules, which Gazebo must not find.
std::vector<std::string> folders_within() {
  std::vector<std::string> folders = plugin_folders();
  const std::size_t n = folders.size();
  for (std::size_t i = 0; i < n; ++i) folders.push_back(folders[i] + "/quadcore");
  return folders;
}

/// Suggest a module, in the folders or built in, with a very similar name.
std::string suggest_module(const std::string& filename) {
  std::vector<std::string> modules;
  for (const auto& [name, module] : built_in_plugins()) {
    if (is_similar(filename, name)) modules.push_back(name);
  }
  for (const std::string& folder : folders_within()) {
    std::error_code unreachable;
    for (const auto& file : std::filesystem::directory_iterator(folder, unreachable)) {
      const std::string name = file.path().filename().string();
      if (file.path().extension() == ".so" && is_similar(filename, name)) modules.push_back(name);
    }
  }
  std::sort(modules.begin(), modules.end());
  return suggest(filename, modules);
}

/// Throw Error if two tags or two wrenches of a plugin have the same name.
void check_names(const PluginDescriptor& descriptor) {
  std::vector<std::string> tags;
  for (const TagSpec& tag : descriptor.tags) {
    tags.push_back(tag.name);
    if (!tag.alias.empty()) tags.push_back(tag.alias);
  }
  for (std::vector<std::string> names : {tags, descriptor.wrenches}) {
    std::sort(names.begin(), names.end());
    const auto twice = std::adjacent_find(names.begin(), names.end());
    if (twice != names.end())
      throw Error("its descriptor names '" + *twice + "' twice. Keep one of them.");
    for (const std::string& name : names) {
      if (name != one_line(name))
        throw Error("its descriptor contains the name '" + name + "'. Use printable text.");
    }
  }
}

const PluginModule& load(const std::string& path, const std::string& who) {
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) throw InputError(who + " cannot be loaded: " + dlerror() + ". Rebuild it.");
  const void* module = dlsym(handle, "quadcore_plugin");
  if (!module) {
    throw InputError(who +
                     " is not a quadcore plugin, or was built for an older version. Use "
                     "QUADCORE_REGISTER_PLUGIN and rebuild it against the installed quadcore.");
  }
  return *static_cast<const PluginModule*>(module);
}

}  // namespace

void load_plugin_path(const std::string& folder) {
  std::error_code unreachable;
  const std::filesystem::path whole = std::filesystem::canonical(folder, unreachable);
  if (unreachable && unreachable != std::errc::no_such_file_or_directory) {
    throw InputError(folder + ": the folder cannot be searched (" + unreachable.message() +
                     "). Give a folder that contains plugin libraries.");
  }
  if (!std::filesystem::is_directory(whole, unreachable)) {
    throw InputError(folder +
                     ": this is not a folder. Give a folder that contains plugin libraries.");
  }
  const std::lock_guard<std::mutex> lock(added_mutex);
  const auto known = std::find(added_folders.begin(), added_folders.end(), whole.string());
  if (known != added_folders.end()) added_folders.erase(known);
  added_folders.insert(added_folders.begin(), whole.string());
}

std::vector<std::string> plugin_folders() {
  std::vector<std::string> folders;
  {
    const std::lock_guard<std::mutex> lock(added_mutex);
    folders = added_folders;
  }
  if (const char* path = std::getenv("QUADCORE_PLUGIN_PATH")) {
    std::istringstream stream(path);
    for (std::string folder; std::getline(stream, folder, ':');) {
      if (!folder.empty()) folders.push_back(folder);
    }
  }
  if (built_in_plugins().empty()) folders.push_back(own_folder());
  return folders;
}

std::optional<std::string> find_plugin(const std::string& filename) {
  if (filename.find('/') != std::string::npos) return std::nullopt;
  for (const std::string& folder : folders_within()) {
    const std::string path = (std::filesystem::path(folder) / filename).string();
    std::error_code unreachable;
    if (std::filesystem::exists(path, unreachable)) return path;
  }
  if (built_in_plugins().count(filename)) return filename;
  return std::nullopt;
}

bool is_named_as_others(const std::string& path) {
  const std::string name = "librotors_gazebo_";
  if (path.find('/') == std::string::npos) return path.rfind(name, 0) == 0;
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  const std::vector<std::string> folders = plugin_folders();
  return std::any_of(folders.begin(), folders.end(), [&](const std::string& folder) {
    return parent == std::filesystem::path(folder) / "quadcore";
  });
}

PluginLibrary open_plugin(const PluginElement& element, const std::string& path) {
  const bool built_in = path.find('/') == std::string::npos;
  const std::string who =
      who_is(element) +
      (built_in ? "" : " in " + std::filesystem::path(path).parent_path().string());
  const PluginModule& module = built_in ? *built_in_plugins().at(path) : load(path, who);
  const auto check = [&who](const std::string& what, const char* built_for, const char* here) {
    if (std::strcmp(built_for, here) == 0) return;
    throw InputError(who + " was built for " + what + " " + built_for + ", but this quadcore has " +
                     here + ". Rebuild it against the installed quadcore.");
  };
  check("plugin interface", module.interface, plugin_interface);
  const PluginDescriptor* descriptor = nullptr;
  try {
    descriptor = module.descriptor();
  } catch (...) {
    throw InputError(who + " failed to return its descriptor: " + what_was_thrown());
  }
  if (!descriptor || !descriptor->create) {
    throw InputError(who + " has no " + (descriptor ? "create in its descriptor" : "descriptor") +
                     ". Add one and rebuild it.");
  }
  if (const char* built_for = descriptor->create.hooks.laws) {
    check("force laws", built_for, law_interface);
  }
  try {
    check_names(*descriptor);
  } catch (const Error& error) {
    throw InputError(who + " has an invalid descriptor: " + error.what());
  }
  return {path, descriptor};
}

std::string describe_missing(const PluginElement& element) {
  const std::string who = who_is(element);
  const std::string remedy = suggest_ignoring(element.filename);
  if (element.filename.find('/') != std::string::npos) {
    return who +
           " is a path. Write only the file name and add its folder to QUADCORE_PLUGIN_PATH." +
           remedy;
  }
  std::vector<std::string> places = plugin_folders();
  if (!built_in_plugins().empty()) places.push_back("the program itself");
  return who + " was not found in " + joined(places) + "." + suggest_module(element.filename) +
         " Correct the file name or add its folder to QUADCORE_PLUGIN_PATH." + remedy;
}

}  // namespace quadcore
