#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <system_error>

#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/tags.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

[[noreturn]] void fail(const std::string& where, const std::string& plugin,
                       const std::string& what) {
  throw InputError(where + ": plugin '" + plugin + "': " + what);
}

/// A value to check, with its location and its plugin.
struct Given {
  Parameter& parameter;
  const std::string& where;
  const std::string& plugin;
  const TagSpec& spec = parameter.spec;

  [[noreturn]] void refuse(const std::string& what) const {
    fail(where, plugin, "<" + spec.name + "> '" + parameter.text + "' " + what);
  }
};

bool is_within(const TagSpec& spec, double value) {
  return (spec.exclusive_min ? value > spec.min : value >= spec.min) && value <= spec.max;
}

void interpret_number(const Given& given) {
  const TagSpec& spec = given.spec;
  const auto value = parse_number(given.parameter.text);
  if (!value) {
    given.refuse("is not a finite number. Write a number" +
                 (spec.unit.empty() ? "" : " in " + spec.unit) + ": " + spec.range() + ".");
  }
  if (!is_within(spec, *value)) {
    given.refuse("is out of range. Use a number " + spec.range() + ".");
  }
  given.parameter.numbers = {*value};
}

void interpret_numbers(const Given& given) {
  const TagSpec& spec = given.spec;
  const std::vector<std::string> words = split(given.parameter.text);
  const std::string instead = ". Write " + spec.range() +
                              (spec.unit.empty() ? "" : ", in " + spec.unit) +
                              ", separated by blanks.";
  if (words.empty() || (spec.count != any_count && words.size() != spec.count)) {
    given.refuse("has " + std::to_string(words.size()) + " numbers" + instead);
  }
  for (const std::string& word : words) {
    const auto value = parse_number(word);
    if (!value) given.refuse("contains '" + word + "', which is not a finite number" + instead);
    if (!is_within(spec, *value))
      given.refuse("contains " + word + ", which is out of range" + instead);
    given.parameter.numbers.push_back(*value);
  }
}

void interpret_choice(const Given& given) {
  // xacro writes booleans as Python does: True.
  if (given.spec.kind == TagKind::flag) given.parameter.text = lower(given.parameter.text);
  const std::vector<std::string>& choices = given.spec.choices;
  if (std::find(choices.begin(), choices.end(), given.parameter.text) == choices.end()) {
    given.refuse("is not a valid value. Use " + given.spec.range() + ".");
  }
}

void interpret_text(const Given& given) {
  // An optional tag without text counts as absent.
  if (!given.parameter.text.empty() || !given.spec.absent.empty()) return;
  given.refuse("is empty. Write a value or remove the tag.");
}

/// A path in a document is relative to the document's folder. A path set by the caller is relative
/// to the current working directory.
void interpret_file(const Given& given) {
  namespace fs = std::filesystem;
  Parameter& parameter = given.parameter;
  interpret_text(given);
  fs::path path = parameter.text;
  if (path.is_relative() && parameter.origin != "set") {
    const fs::path document = given.where.substr(0, given.where.rfind(':'));
    std::error_code ignored;
    if (!fs::exists(document, ignored)) {
      given.refuse(
          "is a relative path, but the model was not read from a file. Write an absolute path.");
    }
    path = document.parent_path() / path;
  }
  parameter.file = path.lexically_normal().string();
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) given.refuse("is a folder. Name a file in it.");
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {
    given.refuse("is not a regular file. Save its content in a regular file.");
  }
  if (!std::ifstream(path)) {
    given.refuse("cannot be read: " + parameter.file + ". Give the path of an existing file" +
                 (path == fs::path(parameter.text)
                      ? ""
                      : ", relative to the document that contains the tag") +
                 ".");
  }
}

void interpret_link(const Given& given, const Model& model) {
  const auto body = model.body_of_link.find(given.parameter.text);
  if (body == model.body_of_link.end()) {
    std::vector<std::string> names;
    for (const auto& entry : model.body_of_link) names.push_back(entry.first);
    given.refuse("is not a link of the model." + suggest(given.parameter.text, names) +
                 " The model has " + joined(names) + ".");
  }
  if (body->second != 0) {
    given.refuse("is not part of the frame. Name the root link '" + model.links[0].name +
                 "' or a link that is fixed to it.");
  }
}

void interpret_joints(const Given& given, const Model& model) {
  Parameter& parameter = given.parameter;
  if (parameter.text.empty()) {
    given.refuse("names no joint. Name at least one or remove the tag.");
  }
  const std::string tag = "<" + given.spec.name + "> names '";
  const std::vector<std::string> names = model.joint_names();
  for (const std::string& name : split(parameter.text)) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      fail(given.where, given.plugin,
           tag + name + "', which is not a continuous joint." + suggest(name, names) +
               " The model has " + joined(names) + ".");
    }
    const auto index = static_cast<std::size_t>(found - names.begin());
    if (std::find(parameter.joints.begin(), parameter.joints.end(), index) !=
        parameter.joints.end()) {
      fail(given.where, given.plugin, tag + name + "' twice. Name it once.");
    }
    parameter.joints.push_back(index);
  }
}

/// Check a value against its specification and interpret it.
void interpret(const Given& given, const Model& model) {
  switch (given.spec.kind) {
    case TagKind::number:
      return interpret_number(given);
    case TagKind::numbers:
      return interpret_numbers(given);
    case TagKind::flag:
    case TagKind::choice:
      return interpret_choice(given);
    case TagKind::text:
      return interpret_text(given);
    case TagKind::file:
      return interpret_file(given);
    case TagKind::link:
      return interpret_link(given, model);
    case TagKind::joints:
      return interpret_joints(given, model);
  }
}

/// Fill in the value that an absent optional tag stands for.
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
    parameters_.push_back({spec, "", ""});
  }
  const auto find = [&](const std::string& tag, const std::string& where) -> Parameter& {
    for (Parameter& parameter : parameters_) {
      if (parameter.spec.name == tag ||
          (!parameter.spec.alias.empty() && parameter.spec.alias == tag)) {
        return parameter;
      }
    }
    fail(where, element.name,
         "unknown tag <" + tag + ">." + suggest(tag, names) + " The plugin accepts " +
             joined(names) + ".");
  };

  for (const PluginTag& tag : element.tags) {
    Parameter& parameter = find(tag.name, tag.where);
    if (!parameter.origin.empty()) {
      fail(tag.where, element.name,
           "<" + tag.name + "> is repeated (first at " + parameter.origin + "). Keep one of them.");
    }
    parameter.text = trimmed(tag.text);
    parameter.origin = tag.where;
  }
  std::map<const Parameter*, std::string> overridden;  // by which name
  for (const auto& [tag, text] : overrides) {
    const std::string where = "set " + element.name + "." + tag;
    Parameter& parameter = find(tag, where);
    const auto [before, is_new] = overridden.try_emplace(&parameter, tag);
    if (!is_new) {
      const std::string other = "<" + before->second + ">";
      fail(where, element.name,
           "is the same tag as " + other + ", which is also set. Keep one of them.");
    }
    parameter.text = trimmed(text);
    parameter.origin = "set";
  }
  for (Parameter& parameter : parameters_) {
    const TagSpec& spec = parameter.spec;
    if (!parameter.origin.empty()) {
      const bool set = parameter.origin == "set";
      const std::string where = set ? "set " + element.name + "." + spec.name : parameter.origin;
      interpret({parameter, where, element.name}, model);
    } else if (spec.required) {
      fail(element.where, element.name,
           "required tag <" + spec.name + "> is missing (" + spec.meaning + "). Add <" + spec.name +
               ">...</" + spec.name + ">" + (spec.unit.empty() ? "" : " in " + spec.unit) + ".");
    } else {
      parameter.origin = "default";
      parameter.text = spec.fallback;
      if (spec.fallback.empty()) {
        complete(parameter, model);
      } else {
        interpret({parameter, element.where, element.name}, model);
      }
    }
  }
}

bool Parameter::agrees_with(const Parameter& other) const {
  if (spec.kind == TagKind::file) return file == other.file;
  return numbers == other.numbers && (!numbers.empty() || text == other.text);
}

const Parameter& Parameters::at(const std::string& tag) const {
  for (const Parameter& parameter : parameters_) {
    if (parameter.spec.name == tag) return parameter;
  }
  throw std::logic_error("the plugin's table has no tag '" + tag + "'");
}

}  // namespace quadcore
