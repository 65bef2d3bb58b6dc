#pragma once

#include <ros/ros.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace quadcore::node {

/// \name What a parameter's value is to be
/// Each throws InputError, naming the parameter, if the value is of another kind.
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
  std::string text(const std::string& name, const std::string& fallback);
  bool flag(const std::string& name, bool fallback);
  std::optional<double> number(const std::string& name);
  double number(const std::string& name, double fallback) {
    return number(name).value_or(fallback);
  }
  std::optional<double> no_negative(const std::string& name, const std::string& hint = "");
  /// Text of words with blanks between them, or a list of texts, which may hold blanks.
  std::vector<std::string> words(const std::string& name);
  /// Throws if the server holds a parameter that nobody asked for: a misspelt one.
  void check_all_known() const;

 private:
  bool get(const std::string& name, XmlRpc::XmlRpcValue& value);

  ros::NodeHandle nh_{"~"};
  std::set<std::string> known_;
};

}  // namespace quadcore::node
