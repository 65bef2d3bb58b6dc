#include "files/yaml_file.hpp"

#include <algorithm>

#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"
#include "quadcore/text_file.hpp"

namespace quadcore::control {
namespace {

std::string shown(const YAML::Node& node) {
  if (node.IsScalar()) return "'" + node.Scalar() + "'";
  return node.IsMap() ? "a mapping" : node.IsSequence() ? "a list" : "nothing";
}

}  // namespace

YamlFile::YamlFile(const std::string& path) : path_(path) {
  const std::string text = read_text_file(path);
  try {
    root_ = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    const std::string line = error.mark.is_null() ? "" : ":" + std::to_string(error.mark.line + 1);
    throw InputError(path + line + ": invalid YAML (" + error.msg + "). Correct this line.");
  }
}

void YamlFile::refuse(const YAML::Node& node, const std::string& what) const {
  const YAML::Mark mark = node.Mark();
  throw InputError(path_ + ":" + std::to_string(mark.is_null() ? 1 : mark.line + 1) + ": " + what);
}

std::vector<std::pair<std::string, YAML::Node>> YamlFile::mapping(const YAML::Node& node,
                                                                  const std::string& name) const {
  if (!node.IsMap()) refuse(node, name + " is " + shown(node) + ". Write lines `NAME: VALUE`.");
  std::vector<std::pair<std::string, YAML::Node>> entries;
  for (const auto& entry : node) {
    const std::string key = text(entry.first, "a name");
    const auto same = [&](const auto& other) { return other.first == key; };
    if (std::any_of(entries.begin(), entries.end(), same)) {
      refuse(entry.first, "'" + key + "' is repeated. Keep one of them.");
    }
    entries.emplace_back(key, entry.second);
  }
  return entries;
}

std::string YamlFile::text(const YAML::Node& node, const std::string& name) const {
  if (!node.IsScalar() || node.Scalar().empty()) {
    refuse(node, name + " is " + shown(node) + ". Write a name.");
  }
  return node.Scalar();
}

double YamlFile::number(const YAML::Node& node, const std::string& name) const {
  const auto value = node.IsScalar() ? parse_number(node.Scalar()) : std::nullopt;
  if (!value) refuse(node, "'" + name + "' is " + shown(node) + ". Write a number.");
  return *value;
}

double YamlFile::number_or_flag(const YAML::Node& node, const std::string& name) const {
  if (node.IsScalar() && node.Scalar() == "true") return 1;
  if (node.IsScalar() && node.Scalar() == "false") return 0;
  return number(node, name);
}

}  // namespace quadcore::control
