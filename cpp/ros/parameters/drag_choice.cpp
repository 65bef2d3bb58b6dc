#include "drag_choice.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin_library.hpp"
#include "quadcore/text.hpp"

namespace quadcore::node {
namespace {

/// Returns the drag for which a tag gives the coefficient.
std::optional<std::string> parse_effect(const std::string& tag) {
  const std::string suffix = "DragCoeff";
  if (tag.size() <= suffix.size()) return std::nullopt;
  const std::size_t end = tag.size() - suffix.size();
  if (tag.compare(end, suffix.size(), suffix) != 0) return std::nullopt;
  return tag.substr(0, end);
}

}  // namespace

void choose_drag(const std::string& drag, const Model& model,
                 std::map<std::string, std::string>& parameters) {
  if (drag == "all") return;
  std::vector<std::string> choices = {"none", "all"};
  for (const PluginElement& element : model.plugins) {
    const std::optional<std::string> path = find_plugin(element.filename);
    if (!path) continue;  // the simulation reports it
    for (const TagSpec& tag : open_plugin(element, *path).descriptor->tags) {
      const std::optional<std::string> effect = parse_effect(tag.name);
      if (!effect) continue;
      choices.push_back(*effect);
      if (*effect == drag) continue;
      const std::string key = element.name + "." + tag.name;
      if (!parameters.emplace(key, "0").second) {
        throw InputError("parameter ~drag: " + drag + " sets " + key +
                         " to 0, but ~set also sets it. Keep one.");
      }
    }
  }
  if (std::find(choices.begin(), choices.end(), drag) != choices.end()) return;
  throw InputError("parameter ~drag: '" + drag + "' does not exist in this model." +
                   suggest(drag, choices) + " Choose one of " + joined(choices) + ".");
}

}  // namespace quadcore::node
