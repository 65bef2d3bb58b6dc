#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <utility>
#include <vector>

namespace quadcore::control {

/// A YAML file; what is wrong with it is told with file and line.
class YamlFile {
 public:
  /// Throws InputError if it cannot be read, or is no YAML.
  explicit YamlFile(const std::string& path);

  const YAML::Node& root() const { return root_; }
  [[noreturn]] void refuse(const YAML::Node& node, const std::string& what) const;

  /// \name What a node holds
  /// Each refuses a node that holds something else. \param name  of it, for errors
  /// @{
  /// Keys, each once, and values.
  std::vector<std::pair<std::string, YAML::Node>> mapping(const YAML::Node& node,
                                                          const std::string& name) const;
  std::string text(const YAML::Node& node, const std::string& name) const;
  double number(const YAML::Node& node, const std::string& name) const;
  /// A number, or a flag as 1 or 0.
  double number_or_flag(const YAML::Node& node, const std::string& name) const;
  /// @}

 private:
  std::string path_;
  YAML::Node root_;
};

}  // namespace quadcore::control
