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

/// Type of a tag's text.
enum class TagKind {
  number,   ///< a finite number within [min, max]
  numbers,  ///< `count` such numbers, separated by blanks
  flag,     ///< true | false
  choice,   ///< one of `choices`
  text,     ///< any text that is not empty
  file,     ///< path of a readable file, relative to the document that contains the tag
  link,     ///< name of a link of the model; empty = the root
  joints,   ///< names of continuous joints, separated by blanks; empty = all, in file order
};

/// TagSpec::count of a row of at least one number.
constexpr std::size_t any_count = 0;

/// Specification of one plugin parameter, used for parsing, errors, `quadcore info` and the docs.
struct TagSpec {
  std::string name;                ///< name of the element
  TagKind kind = TagKind::number;  ///< type of its text
  std::string unit;                ///< "" = none
  std::string fallback;            ///< default value; meaningless if required
  bool required = false;           ///< whether the tag is required
  double min = -std::numeric_limits<double>::infinity();  ///< minimum, in its unit
  double max = std::numeric_limits<double>::infinity();   ///< maximum, in its unit
  bool exclusive_min = false;                             ///< excludes min itself
  std::size_t count = any_count;                          ///< number of values, for `numbers`
  std::vector<std::string> choices;                       ///< valid words, for `choice`
  std::string meaning;                                    ///< one line
  std::string equation;  ///< equation of the thesis or paper, "" = none
  std::string alias;     ///< another accepted name, "" = none
  bool shared = false;   ///< must have the same value in all plugins with this tag
  std::string absent;    ///< for an optional tag without default: meaning of its absence ("off")
  Effect effect = Effect::none;  ///< property of the vehicle that scales with the value
  int power = 0;  ///< exponent: scaling the property by f multiplies the value by f^power

  /// Return the range as text: ">= 0", "true | false", ...
  std::string range() const;
  /// Return only the bounds; "" for none.
  std::string interval() const;

  /// \name Builders
  /// @{

  /// Specify a finite number.
  static TagSpec number(std::string name, std::string unit, std::string fallback,
                        std::string meaning);
  /// Specify several numbers.
  static TagSpec numbers(std::string name, std::string unit, std::string fallback,
                         std::string meaning);
  /// Specify true or false.
  static TagSpec flag(std::string name, std::string fallback, std::string meaning);
  /// Specify one of several words, the first being the default.
  static TagSpec choice(std::string name, std::vector<std::string> choices, std::string meaning);
  /// Specify any text.
  static TagSpec text(std::string name, std::string fallback, std::string meaning);
  /// Specify a readable file; none if absent.
  static TagSpec file(std::string name, std::string meaning);
  /// Specify a link of the model; the root if absent.
  static TagSpec link(std::string name, std::string meaning);
  /// Specify continuous joints of the model; all if absent.
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
  TagSpec spec;                          ///< specification in the plugin's table
  std::string text;                      ///< text as written, or the default; empty = absent
  std::string origin;                    ///< "FILE:LINE", "set" or "default"
  std::vector<double> numbers = {};      ///< values of numbers
  std::string file = {};                 ///< path of a file
  std::vector<std::size_t> joints = {};  ///< indices of joints in the model

  /// Return whether both have the same meaning.
  bool agrees_with(const Parameter& other) const;
};

/// The effective parameters of one plugin, checked against its table.
class Parameters {
 public:
  /// \param overrides  tag name -> text from outside the URDF (--set), which takes precedence.
  /// Throws InputError with FILE:LINE, plugin and tag.
  Parameters(const std::vector<TagSpec>& table, const PluginElement& element, const Model& model,
             const std::map<std::string, std::string>& overrides);

  /// Return a number; 0 if absent.
  double number(const std::string& tag) const { return number_of(at(tag)); }
  /// Return whether the tag has a value or a default.
  bool has(const std::string& tag) const { return !at(tag).text.empty(); }
  /// Return whether the URDF or an override sets the tag.
  bool is_set(const std::string& tag) const { return at(tag).origin != "default"; }
  /// Return a flag; false if absent.
  bool flag(const std::string& tag) const { return at(tag).text == "true"; }
  /// Return a choice; "" if absent.
  const std::string& choice(const std::string& tag) const { return at(tag).text; }
  /// Return the text as written, for any type; "" if absent.
  const std::string& text(const std::string& tag) const { return at(tag).text; }
  /// Return numbers in the unit of the tag; empty if absent.
  const std::vector<double>& numbers(const std::string& tag) const { return at(tag).numbers; }
  /// Return the path of a file; "" if absent.
  const std::string& file(const std::string& tag) const { return at(tag).file; }
  /// Return indices of joints in the model.
  const std::vector<std::size_t>& joints(const std::string& tag) const { return at(tag).joints; }
  /// Return all parameters in the order of the table.
  const std::vector<Parameter>& all() const { return parameters_; }

 private:
  const Parameter& at(const std::string& tag) const;
  static double number_of(const Parameter& p) { return p.numbers.empty() ? 0 : p.numbers.front(); }
  std::vector<Parameter> parameters_;
};

}  // namespace quadcore
