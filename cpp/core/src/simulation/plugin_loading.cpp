#include <algorithm>

#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin_library.hpp"
#include "quadcore/seen_or_sensed.hpp"
#include "quadcore/simulation.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

/// Numbers of state that a plugin may ask for.
constexpr std::size_t max_plugin_state = 1000000;

/// A plugin tag, by the name that the plugin goes by, and the path of its module.
struct Found {
  PluginElement element;
  std::string path;
};

/// A name for a plugin whose own is taken.
std::string another_name(const std::string& name, const std::map<std::string, std::string>& taken) {
  int number = 2;
  while (taken.count(name + "_" + std::to_string(number))) ++number;
  return name + "_" + std::to_string(number);
}

/// Finds the plugins to load, sorted by name, because their order in the document must not matter.
/// A missing module that only senses is skipped; another is refused. So are plugins whose tags
/// cannot be read, and two of one name, except modules named as those of another program, which
/// allows that.
std::vector<Found> find_plugins(const Model& model, PassedOver& passed_over,
                                std::vector<std::string>& warnings) {
  std::vector<Found> plugins;
  std::map<std::string, std::string> by_name;
  for (const PluginElement& element : model.plugins) {
    const auto path = find_plugin(element.filename);
    if (!path && verdict_on_module(element.filename) == Verdict::unfelt) {
      passed_over.add_unfelt(element.filename, element.where);
      continue;
    }
    if (!path) throw InputError(describe_missing(element));
    if (!element.fault.empty()) throw InputError(element.fault);
    Found found{element, *path};
    const auto first = by_name.find(element.name);
    if (first != by_name.end()) {
      const std::string second = element.where + ": a second plugin named '" + element.name +
                                 "' (first at " + first->second + ")";
      if (!is_named_as_others(*path)) throw InputError(second + "; give it another name");
      found.element.name = another_name(element.name, by_name);
      warnings.push_back(second + " goes by the name '" + found.element.name + "'");
    }
    by_name[found.element.name] = element.where;
    plugins.push_back(found);
  }
  std::sort(plugins.begin(), plugins.end(),
            [](const Found& a, const Found& b) { return a.element.name < b.element.name; });
  return plugins;
}

/// "PLUGIN.TAG" -> value becomes PLUGIN -> (TAG -> value); unknown plugins are refused.
std::map<std::string, std::map<std::string, std::string>> by_plugin(
    const std::map<std::string, std::string>& parameters, const std::vector<Found>& plugins) {
  std::vector<std::string> names;
  for (const Found& found : plugins) names.push_back(found.element.name);
  std::map<std::string, std::map<std::string, std::string>> result;
  for (const auto& [key, value] : parameters) {
    const auto dot = key.rfind('.');
    if (dot == std::string::npos || dot == 0 || dot + 1 == key.size()) {
      throw InputError("set " + key + ": is not PLUGIN.TAG; write, for example, " +
                       (names.empty() ? "plugin" : names.front()) + ".sim_slow");
    }
    const std::string plugin = key.substr(0, dot);
    if (std::find(names.begin(), names.end(), plugin) == names.end()) {
      throw InputError("set " + key + ": the model has no plugin '" + plugin + "'" +
                       did_you_mean(plugin, names) + "; it has " + joined(names));
    }
    result[plugin][key.substr(dot + 1)] = value;
  }
  return result;
}

/// Others extend modules that they share the names of. What only senses may be left out then.
Parameters parameters_of(const Found& found, const PluginDescriptor& descriptor, const Model& model,
                         const std::map<std::string, std::string>& overrides) {
  try {
    return {descriptor.tags, found.element, model, overrides};
  } catch (const InputError& error) {
    if (descriptor.create.hooks.forces || !is_named_as_others(found.path)) throw;
    throw InputError(error.what() + ignoring(found.element.filename));
  }
}

/// FILE:LINE of a plugin's tag.
std::string where_of(const LoadedPlugin& p) { return p.who.substr(0, p.who.find(": plugin '")); }

/// A shared tag must mean the same in every plugin that has it.
void check_shared_tags(const std::vector<LoadedPlugin>& plugins) {
  std::map<std::string, std::pair<const LoadedPlugin*, const Parameter*>> first;
  for (const LoadedPlugin& plugin : plugins) {
    for (const Parameter& parameter : plugin.parameters.all()) {
      if (!parameter.spec.shared) continue;
      const auto [known, added] =
          first.emplace(parameter.spec.name, std::pair{&plugin, &parameter});
      const Parameter& other = *known->second.second;
      if (added || parameter.agrees_with(other)) continue;
      const auto describe = [](const LoadedPlugin& p, const Parameter& value) {
        return value.text + " in '" + p.name + "' (" + value.origin + ")";
      };
      const Parameter& blamed = parameter.origin == "default" ? other : parameter;
      throw InputError((blamed.origin == "set" ? "set <" + blamed.spec.name + ">" : blamed.origin) +
                       ": <" + parameter.spec.name + "> is " +
                       describe(*known->second.first, other) + " but " +
                       describe(plugin, parameter) + "; give both the same value");
    }
  }
}

}  // namespace

/// What a model lacks that would make it a vehicle; "" for nothing.
std::string Simulation::describe_idle(const Model& model) const {
  const std::string who = "model '" + model.name + "' has ";
  if (model.joints.empty()) return who + "no rotors: no joint of it is continuous";
  if (wrench_terms_.empty()) {
    return who + "no plugin that reports a force: unless one pushes unsaid, it only falls; add " +
           "libaerodynamic_plugin.so";
  }
  return "";
}

void Simulation::load_plugins(const Model& model, const SimulationOptions& options) {
  PassedOver passed_over = model.passed_over;
  const std::vector<Found> found_plugins = find_plugins(model, passed_over, warnings_);
  warn(passed_over.warning());
  const auto overrides = by_plugin(options.parameters, found_plugins);
  const EngineInfo& engine = engine_info(options.engine);
  Eigen::Index state_size = 0;
  for (const Found& found : found_plugins) {
    const PluginElement& element = found.element;
    const PluginLibrary library = open_plugin(element, found.path);
    const auto given = overrides.find(element.name);
    LoadedPlugin loaded{
        element.name,
        element.filename,
        library.path,
        library.descriptor,
        parameters_of(
            found, *library.descriptor, model,
            given == overrides.end() ? std::map<std::string, std::string>{} : given->second),
        nullptr};
    const std::string who = element.where + ": plugin '" + element.name + "'";
    loaded.who = who;
    const auto alike =
        std::find_if(plugins_.begin(), plugins_.end(), [&](const LoadedPlugin& other) {
          return library.descriptor->adds_up && other.descriptor == library.descriptor;
        });
    for (const std::string& term : library.descriptor->wrenches) {
      if (alike == plugins_.end() &&
          std::find(wrench_terms_.begin(), wrench_terms_.end(), term) != wrench_terms_.end()) {
        throw InputError(who + " reports the wrench '" + term +
                         "', which another plugin reports already; load only one of them");
      }
    }
    loaded.state_begin = state_size;
    topics_.add_plugin(element.name, who);
    try {
      std::vector<std::string> warnings;
      loaded.plugin = library.descriptor->create.make(
          {element.name, loaded.parameters, model, world_, topics_, warnings,
           engine.largest_decay_per_step / dt_, dt_, engine.follows_any_turn});
      if (!loaded.plugin) throw Error("its create() returned no plugin");
      const std::size_t numbers = loaded.plugin->state_size();
      if (numbers > max_plugin_state) {
        throw Error("its state_size() is " + std::to_string(numbers) + "; ask for at most " +
                    std::to_string(max_plugin_state));
      }
      loaded.state_size = static_cast<Eigen::Index>(numbers);
      for (const std::string& warning : warnings) {
        warnings_.push_back(one_line(who + ": " + warning));
      }
    } catch (...) {
      throw InputError(who + " (" + library.path + "): " + what_was_thrown());
    }
    state_size += loaded.state_size;
    loaded.term_begin = wrench_terms_.size();
    if (alike != plugins_.end()) {  // it reports to the same sums
      loaded.term_begin = alike->term_begin;
    } else {
      wrench_terms_.insert(wrench_terms_.end(), library.descriptor->wrenches.begin(),
                           library.descriptor->wrenches.end());
    }
    plugins_.push_back(std::move(loaded));
  }
  check_shared_tags(plugins_);
  warn(describe_idle(model));
  plugin_state_ = VectorXd::Zero(state_size);
  wrenches_.resize(wrench_terms_.size());
}

bool Simulation::has_velocity_in_body() const {
  return std::any_of(plugins_.begin(), plugins_.end(), [](const LoadedPlugin& plugin) {
    const std::vector<Parameter>& all = plugin.parameters.all();
    return std::any_of(all.begin(), all.end(), [](const Parameter& parameter) {
      return parameter.spec.name == "twistFrame" && parameter.text == "body";
    });
  });
}

void Simulation::check_drivers() {
  const std::size_t joints = model_.joints.size();
  std::vector<const LoadedPlugin*> drivers(joints, nullptr);
  for (const LoadedPlugin& p : plugins_) {
    std::vector<RotorDescription> rotors(joints);
    active_ = &p;
    p.plugin->describe_rotors(rotors);
    active_ = nullptr;
    for (std::size_t i = 0; i < joints; ++i) {
      const RotorDescription& rotor = rotors[i];
      if (!rotor.prescribed && !rotor.otherwise && rotor.place == not_driven) continue;
      if (const LoadedPlugin* const first = drivers[i]) {
        throw InputError(p.who + " drives joint '" + model_.joints[i].name + "', as '" +
                         first->name + "' (" + where_of(*first) +
                         ") does already; let one plugin drive each joint");
      }
      drivers[i] = &p;
    }
  }
}

}  // namespace quadcore
