#include "quadcore/control/gains_file.hpp"

#include <algorithm>
#include <utility>

#include "files/yaml_file.hpp"
#include "quadcore/control/controller.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore::control {
namespace {

const std::vector<std::string> keys = {"law", "vehicle", "rate", "delay", "parameters", "history"};

/// Return whether a controller is `MODULE:NAME`, `FILE.py[:NAME]` or the plugin `FILE.so`.
bool is_user_controller(const std::string& name) {
  const auto ends = [&](const std::string& suffix) {
    return name.size() > 3 && name.compare(name.size() - 3, 3, suffix) == 0;
  };
  return name.find(':') != std::string::npos || ends(".py") || ends(".so");
}

}  // namespace

const std::vector<TagSpec>& timing_table() {
  using T = TagSpec;
  static const std::vector<TagSpec> table = {
      T::number("rate", "1/s", "500", "controller calls per second, at most one per step")
          .at_least(1e-6)
          .at_most(1e9),
      T::number("delay", "s", "0", "delay from a call to the first step with its command")
          .at_least(0)
          .at_most(10),
  };
  return table;
}

double default_timing(const std::string& name) {
  const std::vector<TagSpec>& table = timing_table();
  const auto row = std::find_if(table.begin(), table.end(),
                                [&](const TagSpec& spec) { return spec.name == name; });
  return default_of(*row);
}

Gains read_gains(const std::string& path) {
  const YamlFile file(path);
  const auto entries = file.mapping(file.root(), "the gains file");
  const auto entry = [&](const std::string& key) {
    const auto found = std::find_if(entries.begin(), entries.end(),
                                    [&](const auto& other) { return other.first == key; });
    return found == entries.end() ? nullptr : &found->second;
  };
  for (const auto& [key, node] : entries) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      file.refuse(node, "unknown key '" + key + "'." + suggest(key, keys) + " Choose one of " +
                            joined(keys) + ".");
    }
  }
  const auto check = [&](const YAML::Node& node, const std::string& name, const Values& values) {
    if (is_user_controller(name)) return;  // only Python knows its parameters
    try {
      check_values("controller '" + name + "'", Controller::table(name), values);
    } catch (const InputError& error) {
      file.refuse(node, error.what());
    }
  };

  Gains gains;
  const YAML::Node* const law = entry("law");
  if (!law) file.refuse(file.root(), "no controller is named. Write `law: NAME`.");
  gains.law = file.text(*law, "'law'");
  check(*law, gains.law, {});
  if (const YAML::Node* node = entry("vehicle")) gains.vehicle = file.text(*node, "'vehicle'");
  for (const auto& [name, member] : {std::pair{"rate", &Gains::rate}, {"delay", &Gains::delay}}) {
    const YAML::Node* const node = entry(name);
    if (!node) continue;
    gains.*member = file.number(*node, name);
    try {
      check_values("the gains file", timing_table(), {{name, gains.*member}});
    } catch (const InputError& error) {
      file.refuse(*node, error.what());
    }
  }
  if (const YAML::Node* node = entry("parameters")) {
    for (const auto& [name, value] : file.mapping(*node, "'parameters'")) {
      gains.values[name] = file.number_or_flag(value, name);
      check(value, gains.law, {{name, gains.values[name]}});
    }
  }
  if (const YAML::Node* node = entry("history")) {
    if (!node->IsMap() && !node->IsSequence()) {
      file.refuse(*node,
                  "'history' is neither a mapping nor a list. Write one of them or remove it.");
    }
  }
  return gains;
}

}  // namespace quadcore::control
