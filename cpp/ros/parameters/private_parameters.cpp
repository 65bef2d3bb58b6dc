#include "private_parameters.hpp"

#include <cmath>
#include <cstdio>

#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore::node {

using XmlRpc::XmlRpcValue;

void refuse_parameter(const std::string& name, const std::string& wanted) {
  const bool is_whole = name.front() == '~' || name.front() == '/';
  throw InputError("parameter " + (is_whole ? name : "~" + name) + ": give " + wanted);
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

namespace {

std::string written(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", number);
  return text;
}

/// A value as the URDF would write it.
std::string as_text(const std::string& name, const XmlRpcValue& value) {
  XmlRpcValue v = value;
  switch (v.getType()) {
    case XmlRpcValue::TypeBoolean:
      return static_cast<bool>(v) ? "true" : "false";
    case XmlRpcValue::TypeInt:
      return std::to_string(static_cast<int>(v));
    case XmlRpcValue::TypeDouble:
      return written(static_cast<double>(v));
    case XmlRpcValue::TypeString:
      return static_cast<std::string>(v);
    case XmlRpcValue::TypeArray: {
      std::string row;
      for (int i = 0; i < v.size(); ++i) row += (i > 0 ? " " : "") + as_text(name, v[i]);
      return row;
    }
    default:
      refuse_parameter(name, "text, a number, true or false, or a list of these");
  }
}

}  // namespace

PrivateParameters::PrivateParameters(const std::string& space)
    : nh_(space), prefix_(space == "~" ? space : space + "/") {}

std::string PrivateParameters::text(const std::string& name, const std::string& fallback) {
  XmlRpcValue value;
  if (!get(name, value)) return fallback;
  if (value.getType() != XmlRpcValue::TypeString) refuse_parameter(called(name), "text");
  return static_cast<std::string>(value);
}

bool PrivateParameters::flag(const std::string& name, bool fallback) {
  XmlRpcValue value;
  return get(name, value) ? to_flag(called(name), value) : fallback;
}

std::optional<double> PrivateParameters::number(const std::string& name) {
  XmlRpcValue value;
  if (!get(name, value)) return std::nullopt;
  return to_number(called(name), value);
}

std::optional<double> PrivateParameters::no_negative(const std::string& name,
                                                     const std::string& hint) {
  XmlRpcValue value;
  if (!get(name, value)) return std::nullopt;
  return to_no_negative(called(name), value, hint);
}

std::optional<double> PrivateParameters::positive(const std::string& name) {
  const std::optional<double> value = number(name);
  if (value && !(*value > 0)) refuse_parameter(called(name), "a number > 0");
  return value;
}

std::vector<std::string> PrivateParameters::words(const std::string& name) {
  XmlRpcValue value;
  if (!get(name, value)) return {};
  if (value.getType() == XmlRpcValue::TypeString) return split(static_cast<std::string>(value));
  const std::string wanted = "text, or a list of texts";
  if (value.getType() != XmlRpcValue::TypeArray) refuse_parameter(called(name), wanted);
  std::vector<std::string> words;
  for (int i = 0; i < value.size(); ++i) {
    if (value[i].getType() != XmlRpcValue::TypeString) refuse_parameter(called(name), wanted);
    words.push_back(static_cast<std::string>(value[i]));
  }
  return words;
}

std::vector<PluginTag> PrivateParameters::tags(const std::vector<TagSpec>& table) {
  std::vector<PluginTag> given;
  for (const TagSpec& spec : table) {
    for (const std::string& name : {spec.name, spec.alias}) {
      XmlRpcValue value;
      if (name.empty() || !get(name, value)) continue;
      const std::string text = as_text(called(name), value);
      if (!text.empty()) given.push_back({spec.name, text, "parameter " + called(name)});
    }
  }
  return given;
}

/// Names of those there are, without what lies below them.
std::vector<std::string> PrivateParameters::all() const {
  std::vector<std::string> names, own;
  nh_.getParamNames(names);
  const std::string prefix = nh_.getNamespace() + "/";
  for (const std::string& name : names) {
    if (name.compare(0, prefix.size(), prefix) != 0) continue;
    own.push_back(name.substr(prefix.size(), name.find('/', prefix.size()) - prefix.size()));
  }
  return own;
}

void PrivateParameters::check_all_known() const {
  for (const std::string& own : all()) {
    if (known_.count(own) > 0) continue;
    throw InputError("parameter " + called(own) + ": is not known" +
                     did_you_mean(own, {known_.begin(), known_.end()}) +
                     "; it stays on the parameter server until you run: rosparam delete " +
                     nh_.getNamespace() + "/" + own);
  }
}

bool PrivateParameters::get(const std::string& name, XmlRpcValue& value) {
  known_.insert(name);
  return nh_.getParam(name, value);
}

}  // namespace quadcore::node
