#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "quadcore/plugin/effect.hpp"
#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore QUADCORE_EXPORT {

/// What the text of a tag must be.
enum class TagKind {
  number,   ///< a finite number within [min, max]
  numbers,  ///< `count` such numbers, separated by blanks
  flag,     ///< true | false
  choice,   ///< one of `choices`
  text,     ///< anything but nothing
  file,     ///< the path of a file that can be read, relative to the document that holds the tag
  link,     ///< the name of a link of the model; empty = the root
  joints,   ///< names of continuous joints, separated by blanks; empty = all, in file order
};

/// Of a row of numbers: at least one.
constexpr std::size_t any_count = 0;

/// One parameter of a plugin. Parsing, errors, `quadcore info` and the docs all come from here.
struct TagSpec {
  std::string name;                ///< of the element
  TagKind kind = TagKind::number;  ///< what its text must be
  std::string unit;                ///< "" = none
  std::string fallback;            ///< the default; meaningless when required
  bool required = false;           ///< whether a model must have it
  double min = -std::numeric_limits<double>::infinity();  ///< least number, in its unit
  double max = std::numeric_limits<double>::infinity();   ///< greatest number, in its unit
  bool exclusive_min = false;                             ///< min itself is out of range
  std::size_t count = any_count;                          ///< of numbers: how many
  std::vector<std::string> choices;                       ///< of a choice
  std::string meaning;                                    ///< one line
  std::string equation;  ///< equation of the thesis or paper, "" = none
  std::string alias;     ///< another accepted name, "" = none
  bool shared = false;   ///< must have the same value in every plugin of the model that has it
  std::string absent;    ///< of an optional tag without default: what its absence means ("off")
  Effect effect = Effect::none;  ///< property of the vehicle that scales with the number
  int power = 0;                 ///< of the factor on the property that multiplies the number

  /// The range as a person reads it: ">= 0", "true | false", ...
  std::string range() const;
  /// Its bounds alone; "" for none.
  std::string interval() const;

  /// \name Builders, so that a table reads like one
  /// @{

  /// A finite number.
  static TagSpec number(std::string name, std::string unit, std::string fallback,
                        std::string meaning);
  /// Several numbers.
  static TagSpec numbers(std::string name, std::string unit, std::string fallback,
                         std::string meaning);
  /// Either true or false.
  static TagSpec flag(std::string name, std::string fallback, std::string meaning);
  /// One of several words, the first being the default.
  static TagSpec choice(std::string name, std::vector<std::string> choices, std::string meaning);
  /// Any text.
  static TagSpec text(std::string name, std::string fallback, std::string meaning);
  /// A file that can be read; none if absent.
  static TagSpec file(std::string name, std::string meaning);
  /// A link of the model; the root if absent.
  static TagSpec link(std::string name, std::string meaning);
  /// Continuous joints of the model; all if absent.
  static TagSpec joints(std::string name, std::string meaning);
  TagSpec must() const;                                 ///< required
  TagSpec of(std::size_t numbers) const;                ///< count
  TagSpec at_least(double value) const;                 ///< min
  TagSpec above(double value) const;                    ///< exclusive min
  TagSpec at_most(double value) const;                  ///< max
  TagSpec from(std::string equation) const;             ///< equation
  TagSpec also_called(std::string alias) const;         ///< alias
  TagSpec agreed() const;                               ///< shared
  TagSpec or_absent(std::string meaning) const;         ///< no default: absent means this
  TagSpec scaling(Effect effect, int power = 1) const;  ///< effect and power
  /// @}
};

/// A tag with its effective value.
struct Parameter {
  TagSpec spec;                          ///< its row of the plugin's table
  std::string text;                      ///< as written, or the default; empty = absent
  std::string origin;                    ///< "FILE:LINE", "set" or "default"
  std::vector<double> numbers = {};      ///< of a number: it
  std::string file = {};                 ///< the path to open
  std::vector<std::size_t> joints = {};  ///< of joints: their indices in the model

  /// Whether both mean the same.
  bool agrees_with(const Parameter& other) const;
};

/// The effective parameters of one plugin, checked against its table.
class Parameters {
 public:
  /// \param overrides  tag name -> text, given outside the URDF (--set); they win.
  /// Throws InputError with FILE:LINE, plugin and tag.
  Parameters(const std::vector<TagSpec>& table, const PluginElement& element, const Model& model,
             const std::map<std::string, std::string>& overrides);

  /// 0 if absent.
  double number(const std::string& tag) const { return number_of(at(tag)); }
  /// Whether it has a value, be it the default.
  bool has(const std::string& tag) const { return !at(tag).text.empty(); }
  /// Whether the URDF or an override gives it, rather than its default.
  bool is_set(const std::string& tag) const { return at(tag).origin != "default"; }
  /// Value of a flag; false if absent.
  bool flag(const std::string& tag) const { return at(tag).text == "true"; }
  /// What was chosen; "" if absent.
  const std::string& choice(const std::string& tag) const { return at(tag).text; }
  /// As it was written, of whatever kind; "" if absent.
  const std::string& text(const std::string& tag) const { return at(tag).text; }
  /// In the unit of the tag; empty if absent.
  const std::vector<double>& numbers(const std::string& tag) const { return at(tag).numbers; }
  /// The path to open; "" if absent.
  const std::string& file(const std::string& tag) const { return at(tag).file; }
  /// Indices of joints in the model.
  const std::vector<std::size_t>& joints(const std::string& tag) const { return at(tag).joints; }
  /// All of them, in the order of the table.
  const std::vector<Parameter>& all() const { return parameters_; }

 private:
  const Parameter& at(const std::string& tag) const;
  static double number_of(const Parameter& p) { return p.numbers.empty() ? 0 : p.numbers.front(); }
  std::vector<Parameter> parameters_;
};

}  // namespace quadcore
