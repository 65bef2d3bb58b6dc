#pragma once

#include <string>
#include <vector>

#include "laws/airframe.hpp"
#include "laws/rotor_laws.hpp"
#include "quadcore/plugin/tags.hpp"

/// \file
/// The force laws' part of the plugin descriptor.

namespace quadcore::aerodynamic {

using laws::RotorLaws;

/// Call visit(tag) with each tag of each law.
template <class Visit>
void for_each_tag(const Visit& visit) {
  RotorLaws::for_each(RotorLaws::Coefficients<double>{}, [&](const auto& law) {
    for (const laws::Tag& tag : law.tags) visit(tag);
  });
}

inline TagSpec spec_of(const laws::Tag& tag) {
  TagSpec spec = TagSpec::number(tag.name, tag.unit, tag.fallback ? tag.fallback : "", tag.meaning)
                     .from(tag.equation);
  if (tag.range == laws::Tag::at_least_zero) spec = spec.at_least(0);
  if (tag.range == laws::Tag::above_zero) spec = spec.above(0);
  if (tag.scales != Effect::none) spec = spec.scaling(tag.scales);
  return tag.fallback ? spec : spec.must();
}

/// Return the tags of the laws, followed by others.
inline std::vector<TagSpec> tags_of_laws_and(const std::vector<TagSpec>& others) {
  std::vector<TagSpec> tags;
  for_each_tag([&](const laws::Tag& tag) { tags.push_back(spec_of(tag)); });
  for (const laws::Tag& tag : laws::Airframe::tags) tags.push_back(spec_of(tag));
  tags.insert(tags.end(), others.begin(), others.end());
  return tags;
}

/// Return the names of the laws' wrenches.
inline std::vector<std::string> terms_of_laws() {
  std::vector<std::string> terms;
  RotorLaws::for_each(RotorLaws::Coefficients<double>{},
                      [&](const auto& law) { terms.push_back(law.term); });
  return terms;
}

}  // namespace quadcore::aerodynamic
