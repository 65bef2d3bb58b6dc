#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <utility>
#include <vector>

namespace quadcore::control {

/// A YAML file whose errors give file and line.
class YamlFile {
 public:
  /// Throws InputError if the file cannot be read or is not valid YAML.
  explicit YamlFile(const std::string& path);

  const YAML::Node& root() const { return root_; }
  [[noreturn]] void refuse(const YAML::Node& node, const std::string& what) const;

  /// \name Content of a node
  /// All throw InputError for a node with other content. \param name  of the node, for errors
  /// @{
  /// Return the keys, which must be unique, with their values.
  std::vector<std::pair<std::string, YAML::Node>> mapping(const YAML::Node& node,
                                                          const std::string& name) const;
  std::string text(const YAML::Node& node, const std::string& name) const;
  double number(const YAML::Node& node, const std::string& name) const;
  /// Return a number, or a flag as 1 or 0.
  double number_or_flag(const YAML::Node& node, const std::string& name) const;
  /// @}

 private:
  std::string path_;
  YAML::Node root_;
};

}  // namespace quadcore::control
