#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/tags.hpp"

/// \file
/// Parameters of controllers and references. Each has one table, which defines plugin tags, Python
/// keywords, gains files, documentation and errors.

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Values by name; a flag is 0 or 1. Missing values have their defaults.
using Values = std::map<std::string, double>;

/// A number or flag parameter of the class C and its member.
template <class C>
struct Setting {
  TagSpec spec;                                 ///< specification of the parameter
  std::variant<double C::*, bool C::*> member;  ///< member for its value
};
/// All settings of the class C, in the order of their table.
template <class C>
using Settings = std::vector<Setting<C>>;

/// Throw InputError unless the table contains each name and its range each value.
/// \param who  owner of the parameters, for errors: "controller 'pd'"
void check_values(const std::string& who, const std::vector<TagSpec>& table, const Values& values);
/// Return the default value of a row of a table.
double default_of(const TagSpec& spec);
/// Return the table with other defaults.
std::vector<TagSpec> with_defaults(std::vector<TagSpec> table, const Values& defaults);
/// Return the values with names in the table.
Values select_values(const std::vector<TagSpec>& table, const Values& values);
/// Return values, completed with those of `others`.
Values complete(Values values, const Values& others);

/// Return the table of settings, in their order.
template <class C>
std::vector<TagSpec> table_of(const Settings<C>& settings) {
  std::vector<TagSpec> table;
  for (const Setting<C>& setting : settings) table.push_back(setting.spec);
  return table;
}

/// Write checked values or defaults into the members of an object.
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
