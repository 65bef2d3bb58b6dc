#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/tags.hpp"

/// \file
/// Parameters of laws and references: one table each, from which the tags of plugins, the keywords
/// of Python, gains files, documentation and errors come.

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Values by name, a flag being 0 or 1. What is not there has its default.
using Values = std::map<std::string, double>;

/// A number or a flag of the class C, and where it goes.
template <class C>
struct Setting {
  TagSpec spec;                                 ///< what it is called, and may be
  std::variant<double C::*, bool C::*> member;  ///< where its value goes
};
/// All settings of the class C, in the order of their table.
template <class C>
using Settings = std::vector<Setting<C>>;

/// Throws InputError unless each value has a name and a range in the table.
/// \param who  whose parameters these are, for errors: "law 'pd'"
void check_values(const std::string& who, const std::vector<TagSpec>& table, const Values& values);
/// What a row of a table stands for where nothing is given.
double default_of(const TagSpec& spec);
/// The same table with other defaults.
std::vector<TagSpec> with_defaults(std::vector<TagSpec> table, const Values& defaults);
/// Those values whose names a table has.
Values in_table(const std::vector<TagSpec>& table, const Values& values);
/// Values, and those of `others` that they lack.
Values completed(Values values, const Values& others);

/// The table of settings, in their order.
template <class C>
std::vector<TagSpec> table_of(const Settings<C>& settings) {
  std::vector<TagSpec> table;
  for (const Setting<C>& setting : settings) table.push_back(setting.spec);
  return table;
}

/// Writes values that were checked, or defaults, into their places.
template <class C>
void configure(C& object, const Settings<C>& settings, const Values& values) {
  for (const Setting<C>& setting : settings) {
    const auto given = values.find(setting.spec.name);
    const double value = given == values.end() ? default_of(setting.spec) : given->second;
    if (const auto* number = std::get_if<double C::*>(&setting.member)) {
      object.*(*number) = value;
    } else {
      object.*std::get<bool C::*>(setting.member) = value != 0;
    }
  }
}

}  // namespace control
}  // namespace quadcore
