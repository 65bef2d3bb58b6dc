#include "model_path.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

#include "quadcore/text.hpp"

namespace quadcore {
namespace {

namespace fs = std::filesystem;

constexpr int newest_minor = 7;           // Gazebo 11 reads SDF 1.7
constexpr int deepest_package_level = 6;  // folders between ROS_PACKAGE_PATH and a package
/// Files that keep rospack from looking in a folder's folders; a package contains no other.
const char* const last_levels[] = {"package.xml", "CATKIN_IGNORE", "rospack_nosubdirs"};

std::vector<std::string> folders_of(const char* variable) {
  std::vector<std::string> folders;
  const char* value = std::getenv(variable);
  std::istringstream list(value ? value : "");
  for (std::string folder; std::getline(list, folder, ':');) {
    if (!folder.empty()) folders.push_back(folder);
  }
  return folders;
}

bool is_file(const fs::path& path) {
  std::error_code unreachable;
  return fs::is_regular_file(path, unreachable);
}

/// Return the SDF file of a model's folder, or "".
std::string find_sdf(const fs::path& folder) {
  if (is_file(folder)) return folder.string();
  tinyxml2::XMLDocument config;
  std::string name = "model.sdf";
  if (config.LoadFile((folder / "model.config").c_str()) == tinyxml2::XML_SUCCESS) {
    int best = -1;
    const auto* model = config.FirstChildElement("model");
    for (const auto* sdf = model ? model->FirstChildElement("sdf") : nullptr; sdf;
         sdf = sdf->NextSiblingElement("sdf")) {
      const char* version = sdf->Attribute("version");
      const auto minor = parse_number(
          version && std::string(version).rfind("1.", 0) == 0 ? trimmed(version).substr(2) : "0");
      if (!minor || *minor > newest_minor || *minor <= best || !sdf->GetText()) continue;
      best = static_cast<int>(*minor);
      name = trimmed(sdf->GetText());
    }
  }
  const fs::path file = folder / name;
  return is_file(file) ? file.string() : "";
}

/// Append the packages in a folder as rospack finds them, but sorted: the order of a folder's
/// entries is arbitrary. Links may form cycles.
void crawl(const fs::path& folder, int level, std::set<fs::path>& visited,
           std::vector<fs::path>& manifests) {
  std::error_code missing;
  if (!visited.insert(fs::canonical(folder, missing)).second || missing) return;
  if (is_file(folder / "package.xml")) manifests.push_back(folder / "package.xml");
  if (level > deepest_package_level ||
      std::any_of(std::begin(last_levels), std::end(last_levels),
                  [&](const char* name) { return is_file(folder / name); })) {
    return;
  }
  std::vector<fs::path> folders;
  std::error_code unreachable;
  for (fs::directory_iterator at(folder, unreachable), end; !unreachable && at != end;
       at.increment(unreachable)) {
    std::error_code gone;
    if (at->is_directory(gone)) folders.push_back(at->path());
  }
  std::sort(folders.begin(), folders.end());
  for (const fs::path& inner : folders) crawl(inner, level + 1, visited, manifests);
}

/// Return what follows a prefix, or "" if the text begins otherwise.
std::string after(const std::string& text, const std::string& prefix) {
  return text.rfind(prefix, 0) == 0 ? text.substr(prefix.size()) : "";
}

}  // namespace

ModelPath::ModelPath() : folders_(folders_of("GAZEBO_MODEL_PATH")) {
  if (const char* home = std::getenv("HOME")) {
    folders_.push_back(std::string(home) + "/.gazebo/models");
  }
}

/// Return the first place of a URI for which `find` returns a file.
template <class Find>
std::string ModelPath::find_by(const std::string& uri, const Find& find) {
  if (const std::string path = after(uri, "file://"); !path.empty()) return find(path);
  if (const std::string path = after(uri, "package://"); !path.empty()) {
    const std::size_t slash = std::min(path.find('/'), path.size());
    for (const Package& package : packages()) {
      if (package.name == path.substr(0, slash)) return find(package.folder + path.substr(slash));
    }
    return "";
  }
  const std::string name = after(uri, "model://");
  if (name.empty()) return "";
  for (const std::string& folder : folders_) {
    const std::string found = find(fs::path(folder) / name);
    if (!found.empty()) return found;
  }
  for (const Package& package : packages()) {
    for (const std::string& folder : package.model_folders) {
      const std::string found = find(fs::path(folder) / name);
      if (!found.empty()) return found;
    }
  }
  return "";
}

std::string ModelPath::find(const std::string& uri) {
  return find_by(uri, [](const fs::path& path) { return find_sdf(path); });
}

std::string ModelPath::find_file(const std::string& uri) {
  return find_by(uri, [](const fs::path& path) { return is_file(path) ? path.string() : ""; });
}

const std::vector<ModelPath::Package>& ModelPath::packages() {
  if (has_packages_) return packages_;
  has_packages_ = true;
  std::vector<fs::path> files;
  std::set<fs::path> visited;
  for (const std::string& root : folders_of("ROS_PACKAGE_PATH")) {
    crawl(root, 0, visited, files);
  }
  for (const fs::path& file : files) {
    tinyxml2::XMLDocument manifest;
    if (manifest.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS) continue;
    const auto* package = manifest.FirstChildElement("package");
    const auto* name = package ? package->FirstChildElement("name") : nullptr;
    if (!name || !name->GetText()) continue;
    const std::string folder = file.parent_path().string();
    Package found{trimmed(name->GetText()), folder, {}};
    const auto* exported = package->FirstChildElement("export");
    for (const auto* e = exported ? exported->FirstChildElement("gazebo_ros") : nullptr; e;
         e = e->NextSiblingElement("gazebo_ros")) {
      const char* path = e->Attribute("gazebo_model_path");
      if (!path) continue;
      std::string models = path;
      const std::string prefix = "${prefix}";
      if (models.rfind(prefix, 0) == 0) models.replace(0, prefix.size(), folder);
      found.model_folders.push_back(models);
    }
    packages_.push_back(found);
  }
  return packages_;
}

}  // namespace quadcore
