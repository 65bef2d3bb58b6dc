#include <algorithm>
#include <cmath>
#include <limits>

#include "quadcore/harmless_elements.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin_library.hpp"
#include "quadcore/simulation.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

/// Maximum number of state values of a plugin.
constexpr std::size_t max_plugin_state = 1000000;

/// A plugin tag with the effective name of the plugin, and the path of its module.
struct Found {
  PluginElement element;
  std::string path;
};

/// Return an unused name for a plugin whose name is taken.
std::string make_unique_name(const std::string& name,
                             const std::map<std::string, std::string>& taken) {
  int number = 2;
  while (taken.count(name + "_" + std::to_string(number))) ++number;
  return name + "_" + std::to_string(number);
}

/// Find the plugins to load, sorted by name, because their order in the document must not matter.
/// A missing module that only senses is skipped; any other missing module is an error. Unreadable
/// tags and repeated names are errors too, except that RotorS allows repeated names of its modules.
std::vector<Found> find_plugins(const Model& model, IgnoredElements& ignored_elements,
                                std::vector<std::string>& warnings) {
  std::vector<Found> plugins;
  std::map<std::string, std::string> by_name;
  for (const PluginElement& element : model.plugins) {
    const auto path = find_plugin(element.filename);
    if (!path && decide_on_module(element.filename) == Handling::skip) {
      ignored_elements.add_harmless(element.filename, element.where);
      continue;
    }
    if (!path) throw InputError(describe_missing(element));
    if (!element.fault.empty()) throw InputError(element.fault);
    Found found{element, *path};
    const auto first = by_name.find(element.name);
    if (first != by_name.end()) {
      const std::string second = element.where + ": a second plugin is named '" + element.name +
                                 "' (first at " + first->second + ")";
      if (!is_named_as_others(*path)) throw InputError(second + ". Give it another name.");
      found.element.name = make_unique_name(element.name, by_name);
      warnings.push_back(second + ". It is renamed '" + found.element.name + "'.");
    }
    by_name[found.element.name] = element.where;
    plugins.push_back(found);
  }
  std::sort(plugins.begin(), plugins.end(),
            [](const Found& a, const Found& b) { return a.element.name < b.element.name; });
  return plugins;
}

/// Turn "PLUGIN.TAG" -> value into PLUGIN -> (TAG -> value). Unknown plugins are errors.
std::map<std::string, std::map<std::string, std::string>> group_by_plugin(
    const std::map<std::string, std::string>& parameters, const std::vector<Found>& plugins) {
  std::vector<std::string> names;
  for (const Found& found : plugins) names.push_back(found.element.name);
  std::map<std::string, std::map<std::string, std::string>> result;
  for (const auto& [key, value] : parameters) {
    const auto dot = key.rfind('.');
    if (dot == std::string::npos || dot == 0 || dot + 1 == key.size()) {
      throw InputError("set " + key +
                       ": the name is not of the form PLUGIN.TAG. Write, for example, " +
                       (names.empty() ? "plugin" : names.front()) + ".sim_slow.");
    }
    const std::string plugin = key.substr(0, dot);
    if (std::find(names.begin(), names.end(), plugin) == names.end()) {
      throw InputError("set " + key + ": the model has no plugin '" + plugin + "'." +
                       suggest(plugin, names) + " Choose one of " + joined(names) + ".");
    }
    result[plugin][key.substr(dot + 1)] = value;
  }
  return result;
}

/// Return the plugin's parameters. Modules of the same name may have more tags in other programs,
/// so the error suggests suggest_ignoring a module that only senses.
Parameters read_parameters(const Found& found, const PluginDescriptor& descriptor,
                           const Model& model,
                           const std::map<std::string, std::string>& overrides) {
  try {
    return {descriptor.tags, found.element, model, overrides};
  } catch (const InputError& error) {
    if (descriptor.create.hooks.forces || !is_named_as_others(found.path)) throw;
    throw InputError(error.what() + suggest_ignoring(found.element.filename));
  }
}

/// Return FILE:LINE of a plugin's tag.
std::string where_of(const LoadedPlugin& p) { return p.who.substr(0, p.who.find(": plugin '")); }

/// Throw InputError if a shared tag has different values in two plugins.
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
                       describe(plugin, parameter) + ". Give both the same value.");
    }
  }
}

}  // namespace

/// Return a warning about a model that cannot fly; "" for none.
std::string Simulation::describe_idle(const Model& model) const {
  const std::string who = "model '" + model.name + "' has ";
  if (model.joints.empty())
    return who + "no rotors, so it only falls. Make the joints of the rotors continuous.";
  if (wrench_terms_.empty()) {
    return who +
           "no plugin that reports a force, so it probably only falls. Add "
           "libaerodynamic_plugin.so.";
  }
  return "";
}

void Simulation::load_plugins(const Model& model, const SimulationOptions& options) {
  IgnoredElements ignored_elements = model.ignored_elements;
  const std::vector<Found> found_plugins = find_plugins(model, ignored_elements, warnings_);
  warn(ignored_elements.warning());
  const auto overrides = group_by_plugin(options.parameters, found_plugins);
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
        read_parameters(
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
                         "', which another plugin already reports. Load only one of them.");
      }
    }
    loaded.state_begin = state_size;
    topics_.add_plugin(element.name, who);
    try {
      std::vector<std::string> warnings;
      loaded.plugin = library.descriptor->create.make(
          {element.name, loaded.parameters, model, world_, topics_, warnings,
           engine.largest_decay_per_step / dt_, dt_, engine.follows_any_turn});
      if (!loaded.plugin) throw Error("its create() returned no plugin. Return one.");
      const std::size_t numbers = loaded.plugin->state_size();
      if (numbers > max_plugin_state) {
        throw Error("its state_size() is " + std::to_string(numbers) + ". Use at most " +
                    std::to_string(max_plugin_state) + ".");
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
    if (alike != plugins_.end()) {  // it adds to the same wrenches
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
  radii_.assign(joints, std::numeric_limits<double>::quiet_NaN());
  drives_.assign(joints, {});
  for (const LoadedPlugin& p : plugins_) {
    std::vector<RotorDescription> rotors(joints);
    active_ = &p;
    p.plugin->describe_rotors(rotors);
    p.plugin->describe_rotors(drives_);
    active_ = nullptr;
    for (std::size_t i = 0; i < joints; ++i) {
      const RotorDescription& rotor = rotors[i];
      if (!std::isnan(rotor.radius)) radii_[i] = rotor.radius;
      if (!rotor.prescribed && !rotor.otherwise && rotor.place == not_driven) continue;
      if (const LoadedPlugin* const first = drivers[i]) {
        throw InputError(p.who + " drives joint '" + model_.joints[i].name + "', which '" +
                         first->name + "' (" + where_of(*first) +
                         ") already drives. Keep one of them.");
      }
      drivers[i] = &p;
    }
  }
}

}  // namespace quadcore
