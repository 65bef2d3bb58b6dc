#include "quadcore/control/settings.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore::control {
namespace {

/// Format a number with the fewest digits that read back exactly.
std::string written(double value) {
  std::string shortest;
  for (int digits = 1; digits <= 17; ++digits) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(digits);
    text << value;
    shortest = text.str();
    if (parse_number(shortest) == value) break;
  }
  return shortest;
}

bool is_in_range(const TagSpec& spec, double value) {
  if (spec.kind == TagKind::flag) return value == 0 || value == 1;
  return std::isfinite(value) && value <= spec.max &&
         (spec.exclusive_min ? value > spec.min : value >= spec.min);
}

}  // namespace

void check_values(const std::string& who, const std::vector<TagSpec>& table, const Values& values) {
  for (const auto& [name, value] : values) {
    const std::string& wanted = name;
    const auto row = std::find_if(table.begin(), table.end(),
                                  [&](const TagSpec& spec) { return spec.name == wanted; });
    if (row == table.end()) {
      std::vector<std::string> names;
      for (const TagSpec& spec : table) names.push_back(spec.name);
      throw InputError(who + " has no parameter '" + name + "'." + suggest(name, names) +
                       " Choose one of " + joined(names) + ".");
    }
    if (!is_in_range(*row, value)) {
      throw InputError(
          who + ": '" + name + "' is " + written(value) + ". Give " +
          (row->kind == TagKind::flag ? "true or false" : "a finite number " + row->range()) + ".");
    }
  }
}

double default_of(const TagSpec& spec) {
  if (spec.kind == TagKind::flag) return spec.fallback == "true" ? 1 : 0;
  return parse_number(spec.fallback).value_or(0);
}

std::vector<TagSpec> with_defaults(std::vector<TagSpec> table, const Values& defaults) {
  for (TagSpec& spec : table) {
    const auto given = defaults.find(spec.name);
    if (given == defaults.end()) continue;
    spec.fallback = spec.kind == TagKind::flag ? (given->second != 0 ? "true" : "false")
                                               : written(given->second);
  }
  return table;
}

Values select_values(const std::vector<TagSpec>& table, const Values& values) {
  Values known;
  for (const TagSpec& spec : table) {
    const auto given = values.find(spec.name);
    if (given != values.end()) known.insert(*given);
  }
  return known;
}

Values complete(Values values, const Values& others) {
  values.insert(others.begin(), others.end());
  return values;
}

}  // namespace quadcore::control
