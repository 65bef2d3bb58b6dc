#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "quadcore/plugin.hpp"
#include "quadcore/text.hpp"

/// \file
/// Common parts of RotorS' modules: topic names, and tags without effect.

namespace quadcore::rotors {

constexpr const char* motor_model_file = "librotors_gazebo_motor_model.so";
constexpr const char* controller_interface_file = "librotors_gazebo_controller_interface.so";

/// Convert a ROS name to a quadcore name, which allows only letters, digits, _ and the separator /.
inline std::string topic_path(std::string name) {
  name.erase(0, name.find_first_not_of('/'));
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '/';
  };
  std::replace_if(name.begin(), name.end(), [&](char c) { return !is_plain(c); }, '_');
  return name;
}

/// Return a namespace without surrounding slashes.
inline std::string namespace_word(const std::string& name) {
  const std::size_t first = name.find_first_not_of('/');
  if (first == std::string::npos) return "";
  return name.substr(first, name.find_last_not_of('/') - first + 1);
}

/// Return the vehicle's namespace: the shortest (and first) of its motors, or else of its other
/// plugins.
inline std::string vehicle_namespace(const Model& model) {
  std::string of_motors, of_any;
  const auto shorten = [](std::string& shortest, const std::string& name) {
    if (name.empty() || (!shortest.empty() && shortest.size() <= name.size())) return;
    shortest = name;
  };
  for (const PluginElement& plugin : model.plugins) {
    if (plugin.filename.rfind("librotors_gazebo_", 0) != 0) continue;
    for (const PluginTag& tag : plugin.tags) {
      if (tag.name != "robotNamespace") continue;
      shorten(of_any, namespace_word(tag.text));
      if (plugin.filename == motor_model_file) shorten(of_motors, namespace_word(tag.text));
    }
  }
  return of_motors.empty() ? of_any : of_motors;
}

/// Return the topic of a tag, prefixed with the part of the plugin's namespace beyond the
/// vehicle's.
inline std::string topic_of(const PluginSetup& setup, const std::string& tag) {
  const std::string own = namespace_word(setup.parameters.text("robotNamespace"));
  const std::string vehicle = vehicle_namespace(setup.model);
  std::string beyond = own == vehicle ? "" : own;
  if (own.rfind(vehicle + "/", 0) == 0) beyond = own.substr(vehicle.size() + 1);
  return topic_path((beyond.empty() ? "" : beyond + "/") + setup.parameters.text(tag));
}

/// Return the number of motors of a model, which is the size of a command.
inline std::size_t motor_count(const Model& model) {
  return static_cast<std::size_t>(
      std::count_if(model.plugins.begin(), model.plugins.end(),
                    [](const PluginElement& p) { return p.filename == motor_model_file; }));
}

/// Specify a tag of RotorS that has no effect here.
inline TagSpec idle(const std::string& name, const std::string& why) {
  return TagSpec::text(name, "", "no effect: " + why).or_absent("none");
}
inline TagSpec namespace_tag() {
  return TagSpec::text("robotNamespace", "",
                       "namespace; the part beyond the model's shortest namespace is prefixed to "
                       "the topic names")
      .from("RotorS")
      .or_absent("the vehicle's");
}

/// Return the pose in the frame of the link that a tag names.
inline Pose place_of(const PluginSetup& setup, const std::string& tag) {
  return setup.model.pose_of_link.at(setup.parameters.text(tag));
}

}  // namespace quadcore::rotors
