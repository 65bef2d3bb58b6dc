#pragma once

#include <ros/ros.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "quadcore/plugin/tags.hpp"

namespace quadcore::node {

/// \name Conversions of parameter values
/// Each throws InputError with the parameter's name if the value has another type. A name without a
/// leading slash or tilde is private.
/// @{
bool to_flag(const std::string& name, const XmlRpc::XmlRpcValue& value);
double to_number(const std::string& name, const XmlRpc::XmlRpcValue& value);
/// \param hint  additional text for the error
double to_non_negative(const std::string& name, const XmlRpc::XmlRpcValue& value,
                       const std::string& hint = "");
/// @}

/// Throws the InputError for a parameter's value; `wanted` describes valid values.
[[noreturn]] void refuse_parameter(const std::string& name, const std::string& wanted);

/// The private parameters of a node, each read once with type checks.
class PrivateParameters {
 public:
  /// \param space  "~": this node; "~sub": parameters below a private one; "/node": another node
  explicit PrivateParameters(const std::string& space = "~");

  /// Whether any parameter exists.
  bool any() const { return !all().empty(); }
  std::string text(const std::string& name, const std::string& fallback);
  bool flag(const std::string& name, bool fallback);
  std::optional<double> number(const std::string& name);
  double number(const std::string& name, double fallback) {
    return number(name).value_or(fallback);
  }
  /// Reads a whole number in [least, most].
  double whole(const std::string& name, double fallback, double least, double most);
  std::optional<double> non_negative(const std::string& name, const std::string& hint = "");
  std::optional<double> positive(const std::string& name);
  /// Reads words separated by blanks, or a list of texts, which may contain blanks.
  std::vector<std::string> words(const std::string& name);
  /// Reads the given tags of a table, as from a URDF. Empty texts are skipped.
  std::vector<PluginTag> tags(const std::vector<TagSpec>& table);
  /// Marks a parameter with nested parameters as known; other PrivateParameters read these.
  void know(const std::string& name) { known_.insert(name); }
  /// Throws InputError if the server has a parameter that was not read: a misspelt one.
  void check_all_known() const;

 private:
  bool get(const std::string& name, XmlRpc::XmlRpcValue& value);
  std::vector<std::string> all() const;
  std::string full_name(const std::string& name) const { return prefix_ + name; }

  ros::NodeHandle nh_;
  std::string prefix_;  ///< prefix of names in errors
  std::set<std::string> known_;
};

}  // namespace quadcore::node
