#include "private_parameters.hpp"

#include <cmath>

#include "quadcore/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore::node {

using XmlRpc::XmlRpcValue;

void refuse_parameter(const std::string& name, const std::string& wanted) {
  throw InputError("parameter ~" + name + ": give " + wanted);
}

// roscpp's conversions are members of values that may change.

bool to_flag(const std::string& name, const XmlRpcValue& value) {
  if (value.getType() != XmlRpcValue::TypeBoolean) refuse_parameter(name, "true or false");
  return static_cast<bool>(XmlRpcValue(value));
}

double to_number(const std::string& name, const XmlRpcValue& value) {
  double number = 0;
  if (value.getType() == XmlRpcValue::TypeInt) {
    number = static_cast<int>(XmlRpcValue(value));
  } else if (value.getType() == XmlRpcValue::TypeDouble) {
    number = static_cast<double>(XmlRpcValue(value));
  } else {
    refuse_parameter(name, "a number");
  }
  if (!std::isfinite(number)) refuse_parameter(name, "a finite number");
  return number;
}

double to_no_negative(const std::string& name, const XmlRpcValue& value, const std::string& hint) {
  const double number = to_number(name, value);
  if (number < 0) refuse_parameter(name, "a number >= 0" + hint);
  return number;
}

std::string PrivateParameters::text(const std::string& name, const std::string& fallback) {
  XmlRpcValue value;
  if (!get(name, value)) return fallback;
  if (value.getType() != XmlRpcValue::TypeString) refuse_parameter(name, "text");
  return static_cast<std::string>(value);
}

bool PrivateParameters::flag(const std::string& name, bool fallback) {
  XmlRpcValue value;
  return get(name, value) ? to_flag(name, value) : fallback;
}

std::optional<double> PrivateParameters::number(const std::string& name) {
  XmlRpcValue value;
  if (!get(name, value)) return std::nullopt;
  return to_number(name, value);
}

std::optional<double> PrivateParameters::no_negative(const std::string& name,
                                                     const std::string& hint) {
  XmlRpcValue value;
  if (!get(name, value)) return std::nullopt;
  return to_no_negative(name, value, hint);
}

std::vector<std::string> PrivateParameters::words(const std::string& name) {
  XmlRpcValue value;
  if (!get(name, value)) return {};
  if (value.getType() == XmlRpcValue::TypeString) return split(static_cast<std::string>(value));
  const std::string wanted = "text, or a list of texts";
  if (value.getType() != XmlRpcValue::TypeArray) refuse_parameter(name, wanted);
  std::vector<std::string> words;
  for (int i = 0; i < value.size(); ++i) {
    if (value[i].getType() != XmlRpcValue::TypeString) refuse_parameter(name, wanted);
    words.push_back(static_cast<std::string>(value[i]));
  }
  return words;
}

void PrivateParameters::check_all_known() const {
  std::vector<std::string> names;
  nh_.getParamNames(names);
  const std::string prefix = nh_.getNamespace() + "/";
  for (const std::string& name : names) {
    if (name.compare(0, prefix.size(), prefix) != 0) continue;
    const std::string own =
        name.substr(prefix.size(), name.find('/', prefix.size()) - prefix.size());
    if (known_.count(own) > 0) continue;
    throw InputError(
        "parameter ~" + own + ": is not known" + did_you_mean(own, {known_.begin(), known_.end()}) +
        "; it stays on the parameter server until you run: rosparam delete " + prefix + own);
  }
}

bool PrivateParameters::get(const std::string& name, XmlRpcValue& value) {
  known_.insert(name);
  return nh_.getParam(name, value);
}

}  // namespace quadcore::node
