#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "quadcore/control/settings.hpp"

/// \file
/// The tables of several laws or shapes as the tags of one plugin.

namespace quadcore::control {

/// The rows of all tables, each name once; what is absent has the default of the one that is
/// chosen.
/// \param tables  (who has it, table)
inline std::vector<TagSpec> tags_of(
    const std::vector<std::pair<std::string, std::vector<TagSpec>>>& tables) {
  std::vector<TagSpec> tags;
  for (const auto& [who, table] : tables) {
    for (const TagSpec& spec : table) {
      const std::string of = who + ": " + (spec.fallback.empty() ? "off" : spec.fallback);
      const auto same = [&](const TagSpec& tag) { return tag.name == spec.name; };
      const auto known = std::find_if(tags.begin(), tags.end(), same);
      if (known != tags.end()) {
        known->absent += ", " + of;
        continue;
      }
      tags.push_back(spec);
      tags.back().fallback.clear();
      tags.back().absent = of;
    }
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
