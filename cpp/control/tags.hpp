#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "quadcore/control/settings.hpp"
#include "quadcore/text.hpp"

/// \file
/// The tables of several laws or shapes as the tags of one plugin.

namespace quadcore::control {

/// What a parameter is by default, and for whom.
struct Defaults {
  std::vector<std::pair<std::string, std::vector<std::string>>> values;  ///< value, names

  void add(const std::string& value, const std::string& who) {
    for (auto& [known, names] : values) {
      if (known == value) return names.push_back(who);
    }
    values.push_back({value, {who}});
  }
  /// "2.4 (pd, pid), 9 (indi)", or the value alone where all of so many names have it.
  std::string text(std::size_t all) const {
    std::string text;
    for (const auto& [value, names] : values) {
      if (names.size() == all) return value;
      text += (text.empty() ? "" : ", ") + value + " (" + joined(names) + ")";
    }
    return text;
  }
};

/// The rows of all tables, each name once; what is absent has the default of the one that is
/// chosen. Throws std::logic_error if a name has two units.
/// \param tables  (who has it, table)
inline std::vector<TagSpec> tags_of(
    const std::vector<std::pair<std::string, std::vector<TagSpec>>>& tables) {
  std::vector<TagSpec> tags;
  std::vector<Defaults> defaults;
  for (const auto& [who, table] : tables) {
    for (const TagSpec& spec : table) {
      const auto same = [&](const TagSpec& tag) { return tag.name == spec.name; };
      const auto known = std::find_if(tags.begin(), tags.end(), same);
      const auto i = static_cast<std::size_t>(known - tags.begin());
      if (known == tags.end()) {
        tags.push_back(spec);
        defaults.emplace_back();
      } else if (known->unit != spec.unit) {
        throw std::logic_error("parameter '" + spec.name + "' has two units");
      }
      defaults[i].add(spec.fallback.empty() ? "off" : spec.fallback, who);
    }
  }
  for (std::size_t i = 0; i < tags.size(); ++i) {
    tags[i] = tags[i].or_absent(defaults[i].text(tables.size()));
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
