#include "quadcore/plugin/tags.hpp"

#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>

namespace quadcore {

TagSpec TagSpec::number(std::string name, std::string unit, std::string fallback,
                        std::string meaning) {
  TagSpec spec;
  spec.name = std::move(name);
  spec.unit = std::move(unit);
  spec.fallback = std::move(fallback);
  spec.meaning = std::move(meaning);
  return spec;
}
TagSpec TagSpec::numbers(std::string name, std::string unit, std::string fallback,
                         std::string meaning) {
  TagSpec spec = number(std::move(name), std::move(unit), std::move(fallback), std::move(meaning));
  spec.kind = TagKind::numbers;
  return spec;
}
TagSpec TagSpec::flag(std::string name, std::string fallback, std::string meaning) {
  TagSpec spec = number(std::move(name), "", std::move(fallback), std::move(meaning));
  spec.kind = TagKind::flag;
  spec.choices = {"true", "false"};
  return spec;
}
TagSpec TagSpec::choice(std::string name, std::vector<std::string> choices, std::string meaning) {
  TagSpec spec = number(std::move(name), "", choices.front(), std::move(meaning));
  spec.kind = TagKind::choice;
  spec.choices = std::move(choices);
  return spec;
}
TagSpec TagSpec::text(std::string name, std::string fallback, std::string meaning) {
  TagSpec spec = number(std::move(name), "", std::move(fallback), std::move(meaning));
  spec.kind = TagKind::text;
  return spec;
}
TagSpec TagSpec::file(std::string name, std::string meaning) {
  TagSpec spec = number(std::move(name), "", "", std::move(meaning));
  spec.kind = TagKind::file;
  spec.absent = "none";
  return spec;
}
TagSpec TagSpec::link(std::string name, std::string meaning) {
  TagSpec spec = number(std::move(name), "", "", std::move(meaning));
  spec.kind = TagKind::link;
  spec.absent = "the root link";
  return spec;
}
TagSpec TagSpec::joints(std::string name, std::string meaning) {
  TagSpec spec = number(std::move(name), "", "", std::move(meaning));
  spec.kind = TagKind::joints;
  spec.absent = "all continuous joints, in file order";
  return spec;
}

TagSpec TagSpec::must() const {
  TagSpec spec = *this;
  spec.required = true;
  return spec;
}
TagSpec TagSpec::of(std::size_t numbers) const {
  TagSpec spec = *this;
  spec.count = numbers;
  return spec;
}
TagSpec TagSpec::at_least(double value) const {
  TagSpec spec = *this;
  spec.min = value;
  return spec;
}
TagSpec TagSpec::above(double value) const {
  TagSpec spec = at_least(value);
  spec.exclusive_min = true;
  return spec;
}
TagSpec TagSpec::at_most(double value) const {
  TagSpec spec = *this;
  spec.max = value;
  return spec;
}
TagSpec TagSpec::from(std::string source) const {
  TagSpec spec = *this;
  spec.equation = std::move(source);
  return spec;
}
TagSpec TagSpec::also_called(std::string other) const {
  TagSpec spec = *this;
  spec.alias = std::move(other);
  return spec;
}
TagSpec TagSpec::agreed() const {
  TagSpec spec = *this;
  spec.shared = true;
  return spec;
}
TagSpec TagSpec::or_absent(std::string what) const {
  TagSpec spec = *this;
  spec.fallback.clear();
  spec.absent = std::move(what);
  return spec;
}
TagSpec TagSpec::scaling(Effect what, int with_power) const {
  TagSpec spec = *this;
  spec.effect = what;
  spec.power = with_power;
  return spec;
}

std::string TagSpec::interval() const {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(16);
  if (std::isfinite(min)) text << (exclusive_min ? "> " : ">= ") << min;
  if (std::isfinite(max)) text << (std::isfinite(min) ? ", " : "") << "<= " << max;
  return text.str();
}

std::string TagSpec::range() const {
  const std::string within = interval();
  switch (kind) {
    case TagKind::number:
      return within.empty() ? "any finite number" : within;
    case TagKind::numbers:
      return (count == any_count ? "" : std::to_string(count) + " ") +
             (within.empty() ? "finite numbers" : "numbers, each " + within);
    case TagKind::flag:
    case TagKind::choice: {
      std::string text;
      for (const std::string& c : choices) text += (text.empty() ? "" : " | ") + c;
      return text;
    }
    case TagKind::text:
      return "any text";
    case TagKind::file:
      return "a file, relative to the model";
    case TagKind::link:
      return "a link of the model";
    case TagKind::joints:
      return "names of continuous joints";
  }
  return "";
}

}  // namespace quadcore
