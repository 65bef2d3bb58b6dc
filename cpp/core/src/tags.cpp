#include "quadcore/tags.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "quadcore/error.hpp"
#include "quadcore/text.hpp"

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
TagSpec TagSpec::link(std::string name, std::string meaning) {
  TagSpec spec = number(std::move(name), "", "", std::move(meaning));
  spec.kind = TagKind::link;
  spec.absent = "the root link";
  return spec;
}
TagSpec TagSpec::joints(std::string name, std::string meaning) {
  TagSpec spec = number(std::move(name), "", "", std::move(meaning));
  spec.kind = TagKind::joints;
  spec.absent = "every continuous joint, in file order";
  return spec;
}

TagSpec TagSpec::must() const {
  TagSpec spec = *this;
  spec.required = true;
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

std::string TagSpec::range() const {
  switch (kind) {
    case TagKind::flag:
    case TagKind::choice: {
      std::string text;
      for (const std::string& c : choices) text += (text.empty() ? "" : " | ") + c;
      return text;
    }
    case TagKind::link:
      return "a link of the model";
    case TagKind::joints:
      return "names of continuous joints";
    case TagKind::number:
      break;
  }
  std::ostringstream text;
  text << std::setprecision(16);
  if (std::isfinite(min)) text << (exclusive_min ? "> " : ">= ") << min;
  if (std::isfinite(max)) text << (std::isfinite(min) ? ", " : "") << "<= " << max;
  return text.str().empty() ? "any finite number" : text.str();
}

namespace {

[[noreturn]] void fail(const std::string& where, const std::string& plugin,
                       const std::string& what) {
  throw InputError(where + ": plugin '" + plugin + "': " + what);
}

/// Checks a value against its spec and fills in what it means.
void interpret(Parameter& parameter, const std::string& where, const std::string& plugin,
               const Model& model) {
  const TagSpec& spec = parameter.spec;
  const std::string quoted = "<" + spec.name + "> '" + parameter.text + "' ";
  switch (spec.kind) {
    case TagKind::number: {
      const auto value = parse_number(parameter.text);
      if (!value) {
        fail(where, plugin,
             quoted + "is not a finite number; write " +
                 (spec.unit.empty() ? "a plain number" : "a plain number in " + spec.unit) + ", " +
                 spec.range());
      }
      const bool too_low = spec.exclusive_min ? !(*value > spec.min) : *value < spec.min;
      if (too_low || *value > spec.max) {
        fail(where, plugin, quoted + "is out of range; write a number " + spec.range());
      }
      parameter.number = *value;
      return;
    }
    case TagKind::flag:
    case TagKind::choice:
      if (std::find(spec.choices.begin(), spec.choices.end(), parameter.text) ==
          spec.choices.end()) {
        fail(where, plugin, quoted + "is not a choice; write " + spec.range());
      }
      return;
    case TagKind::link: {
      const auto body = model.body_of_link.find(parameter.text);
      if (body == model.body_of_link.end()) {
        std::vector<std::string> names;
        for (const auto& entry : model.body_of_link) names.push_back(entry.first);
        fail(where, plugin,
             quoted + "is not a link of the model" + did_you_mean(parameter.text, names) +
                 "; its links are " + joined(names));
      }
      if (body->second != 0) {
        fail(where, plugin,
             quoted + "is not part of the frame; name the root link '" + model.links[0].name +
                 "' or one that is fixed to it");
      }
      return;
    }
    case TagKind::joints:
      if (parameter.text.empty()) {
        fail(where, plugin, quoted + "names no joint; name at least one or leave the tag out");
      }
      for (const std::string& name : split(parameter.text)) {
        const std::vector<std::string> names = model.joint_names();
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) {
          fail(where, plugin,
               "<" + spec.name + "> names '" + name + "', which is not a continuous joint" +
                   did_you_mean(name, names) + "; the model has " + joined(names));
        }
        const auto index = static_cast<std::size_t>(found - names.begin());
        if (std::find(parameter.joints.begin(), parameter.joints.end(), index) !=
            parameter.joints.end()) {
          fail(where, plugin, "<" + spec.name + "> names '" + name + "' twice; name it once");
        }
        parameter.joints.push_back(index);
      }
      return;
  }
}

/// What an absent optional tag stands for.
void complete(Parameter& parameter, const Model& model) {
  if (parameter.spec.kind == TagKind::link) parameter.text = model.links[0].name;
  if (parameter.spec.kind != TagKind::joints) return;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    parameter.joints.push_back(i);
    parameter.text += (i ? " " : "") + model.joints[i].name;
  }
}

}  // namespace

Parameters::Parameters(const std::vector<TagSpec>& table, const PluginElement& element,
                       const Model& model, const std::map<std::string, std::string>& overrides) {
  std::vector<std::string> names;
  for (const TagSpec& spec : table) {
    names.push_back(spec.name);
    if (!spec.alias.empty()) names.push_back(spec.alias);
    parameters_.push_back({spec, "", "", 0, {}});
  }
  const auto find = [&](const std::string& tag, const std::string& where) -> Parameter& {
    for (Parameter& parameter : parameters_) {
      if (parameter.spec.name == tag ||
          (!parameter.spec.alias.empty() && parameter.spec.alias == tag)) {
        return parameter;
      }
    }
    fail(where, element.name,
         "unknown tag <" + tag + ">" + did_you_mean(tag, names) + "; it knows " + joined(names));
  };

  for (const PluginTag& tag : element.tags) {
    Parameter& parameter = find(tag.name, tag.where);
    if (!parameter.origin.empty()) {
      fail(tag.where, element.name,
           "<" + tag.name + "> is given a second time (first at " + parameter.origin +
               "); keep one of them");
    }
    parameter.text = trimmed(tag.text);
    parameter.origin = tag.where;
  }
  for (const auto& [tag, text] : overrides) {
    Parameter& parameter = find(tag, "set " + element.name + "." + tag);
    parameter.text = trimmed(text);
    parameter.origin = "set";
  }
  for (Parameter& parameter : parameters_) {
    const TagSpec& spec = parameter.spec;
    if (!parameter.origin.empty()) {
      const bool set = parameter.origin == "set";
      interpret(parameter, set ? "set " + element.name + "." + spec.name : parameter.origin,
                element.name, model);
    } else if (spec.required) {
      fail(element.where, element.name,
           "required tag <" + spec.name + "> is missing (" + spec.meaning + "); add <" + spec.name +
               ">...</" + spec.name + ">" + (spec.unit.empty() ? "" : " in " + spec.unit));
    } else {
      parameter.origin = "default";
      parameter.text = spec.fallback;
      if (spec.fallback.empty()) {
        complete(parameter, model);
      } else {
        interpret(parameter, element.where, element.name, model);
      }
    }
  }
}

const Parameter& Parameters::at(const std::string& tag) const {
  for (const Parameter& parameter : parameters_) {
    if (parameter.spec.name == tag) return parameter;
  }
  throw std::logic_error("the plugin's table has no tag '" + tag + "'");
}

}  // namespace quadcore
