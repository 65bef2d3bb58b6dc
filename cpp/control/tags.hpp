#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "quadcore/control/settings.hpp"
#include "quadcore/text.hpp"

/// \file
/// Merges the tables of several controllers or references into the tags of one plugin.

namespace quadcore::control {

/// Texts on a parameter with the names of the controllers or references that they apply to.
struct MergedText {
  std::vector<std::pair<std::string, std::vector<std::string>>> texts;  ///< text, names

  void add(const std::string& text, const std::string& who) {
    for (auto& [known, names] : texts) {
      if (known == text) return names.push_back(who);
    }
    texts.push_back({text, {who}});
  }
  /// Return "2.4 (pd, pid), 9 (indi)", or only the text if it applies to all names. Empty texts are
  /// omitted.
  std::string text(std::size_t all) const {
    std::string text;
    for (const auto& [said, names] : texts) {
      if (names.size() == all) return said;
      if (!said.empty()) text += (text.empty() ? "" : ", ") + said + " (" + joined(names) + ")";
    }
    return text;
  }
};

/// Return the rows of all tables, each name once with the merged texts. Absent tags have the
/// default of the chosen controller or reference. Throws std::logic_error if a name has two units
/// or ranges.
/// \param tables  (name of the owner, table)
inline std::vector<TagSpec> merge_tags(
    const std::vector<std::pair<std::string, std::vector<TagSpec>>>& tables) {
  struct Merged {
    MergedText defaults, meanings, equations;
    std::size_t count = 0;
  };
  std::vector<TagSpec> tags;
  std::vector<Merged> merged;
  for (const auto& [who, table] : tables) {
    for (const TagSpec& spec : table) {
      const auto same = [&](const TagSpec& tag) { return tag.name == spec.name; };
      const auto known = std::find_if(tags.begin(), tags.end(), same);
      const auto i = static_cast<std::size_t>(known - tags.begin());
      if (known == tags.end()) {
        tags.push_back(spec);
        merged.emplace_back();
      } else if (known->unit != spec.unit || known->range() != spec.range()) {
        throw std::logic_error("parameter '" + spec.name + "' has two units or ranges");
      }
      merged[i].count += 1;
      merged[i].defaults.add(spec.fallback.empty() ? "off" : spec.fallback, who);
      merged[i].meanings.add(spec.meaning, who);
      merged[i].equations.add(spec.equation, who);
    }
  }
  for (std::size_t i = 0; i < tags.size(); ++i) {
    // For a parameter of only some owners, the default lists their names.
    tags[i] = tags[i].or_absent(merged[i].defaults.text(tables.size()));
    tags[i].meaning = merged[i].meanings.text(merged[i].count);
    tags[i].equation = merged[i].equations.text(merged[i].count);
  }
  return tags;
}

/// What the tags of a table are set to.
inline Values values_of(const Parameters& parameters, const std::vector<TagSpec>& all) {
  Values values;
  for (const TagSpec& spec : all) {
    if (!parameters.is_set(spec.name)) continue;
    values[spec.name] = spec.kind == TagKind::flag ? (parameters.flag(spec.name) ? 1 : 0)
                                                   : parameters.number(spec.name);
  }
  return values;
}

}  // namespace quadcore::control
