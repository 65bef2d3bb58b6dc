#pragma once

#include <ros/ros.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "quadcore/plugin/tags.hpp"

namespace quadcore::node {

/// \name What a parameter's value is to be
/// Each throws InputError, naming the parameter, if the value is of another kind. A name without a
/// slash or tilde before it is one of the node's own.
/// @{
bool to_flag(const std::string& name, const XmlRpc::XmlRpcValue& value);
double to_number(const std::string& name, const XmlRpc::XmlRpcValue& value);
/// \param hint  what else is to be said of the number
double to_no_negative(const std::string& name, const XmlRpc::XmlRpcValue& value,
                      const std::string& hint = "");
/// @}

/// Throws the InputError of a parameter's value that is to be `wanted`.
[[noreturn]] void refuse_parameter(const std::string& name, const std::string& wanted);

/// The private parameters of a node, each read once and strictly.
class PrivateParameters {
 public:
  /// \param space  "~": of this node; "~sub": those below one of them; "/node": of another node
  explicit PrivateParameters(const std::string& space = "~");

  /// Whether there are any.
  bool any() const { return !all().empty(); }
  std::string text(const std::string& name, const std::string& fallback);
  bool flag(const std::string& name, bool fallback);
  std::optional<double> number(const std::string& name);
  double number(const std::string& name, double fallback) {
    return number(name).value_or(fallback);
  }
  std::optional<double> no_negative(const std::string& name, const std::string& hint = "");
  std::optional<double> positive(const std::string& name);
  /// Text of words with blanks between them, or a list of texts, which may hold blanks.
  std::vector<std::string> words(const std::string& name);
  /// What is given of a table of tags, as if the URDF said it. Empty text gives nothing.
  std::vector<PluginTag> tags(const std::vector<TagSpec>& table);
  /// Parameters that lie below one, for which PrivateParameters of their own ask.
  void know(const std::string& name) { known_.insert(name); }
  /// Throws if the server holds a parameter that nobody asked for: a misspelt one.
  void check_all_known() const;

 private:
  bool get(const std::string& name, XmlRpc::XmlRpcValue& value);
  std::vector<std::string> all() const;
  std::string called(const std::string& name) const { return prefix_ + name; }

  ros::NodeHandle nh_;
  std::string prefix_;  ///< of names in errors
  std::set<std::string> known_;
};

}  // namespace quadcore::node
