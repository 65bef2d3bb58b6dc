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

// roscpp's conversions are non-const members, so the functions copy a value first.

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

double to_non_negative(const std::string& name, const XmlRpcValue& value, const std::string& hint) {
  const double number = to_number(name, value);
  if (number < 0) refuse_parameter(name, "a number >= 0" + hint);
  return number;
}

namespace {

std::string format_number(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", number);
  return text;
}

/// Writes a value as in a URDF.
std::string format_value(const std::string& name, const XmlRpcValue& value) {
  XmlRpcValue v = value;
  switch (v.getType()) {
    case XmlRpcValue::TypeBoolean:
      return static_cast<bool>(v) ? "true" : "false";
    case XmlRpcValue::TypeInt:
      return std::to_string(static_cast<int>(v));
    case XmlRpcValue::TypeDouble:
      return format_number(static_cast<double>(v));
    case XmlRpcValue::TypeString:
      return static_cast<std::string>(v);
    case XmlRpcValue::TypeArray: {
      std::string row;
      for (int i = 0; i < v.size(); ++i) row += (i > 0 ? " " : "") + format_value(name, v[i]);
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
  if (value.getType() != XmlRpcValue::TypeString) refuse_parameter(full_name(name), "text");
  return static_cast<std::string>(value);
}

bool PrivateParameters::flag(const std::string& name, bool fallback) {
  XmlRpcValue value;
  return get(name, value) ? to_flag(full_name(name), value) : fallback;
}

std::optional<double> PrivateParameters::number(const std::string& name) {
  XmlRpcValue value;
  if (!get(name, value)) return std::nullopt;
  return to_number(full_name(name), value);
}

std::optional<double> PrivateParameters::non_negative(const std::string& name,
                                                      const std::string& hint) {
  XmlRpcValue value;
  if (!get(name, value)) return std::nullopt;
  return to_non_negative(full_name(name), value, hint);
}

double PrivateParameters::whole(const std::string& name, double fallback, double least,
                                double most) {
  const double value = number(name, fallback);
  if (value != std::floor(value) || value < least || value > most) {
    char range[64];
    std::snprintf(range, sizeof range, "a whole number from %.0f to %.0f", least, most);
    refuse_parameter(name, range);
  }
  return value;
}

std::optional<double> PrivateParameters::positive(const std::string& name) {
  const std::optional<double> value = number(name);
  if (value && !(*value > 0)) refuse_parameter(full_name(name), "a number > 0");
  return value;
}

std::vector<std::string> PrivateParameters::words(const std::string& name) {
  XmlRpcValue value;
  if (!get(name, value)) return {};
  if (value.getType() == XmlRpcValue::TypeString) return split(static_cast<std::string>(value));
  const std::string wanted = "text, or a list of texts";
  if (value.getType() != XmlRpcValue::TypeArray) refuse_parameter(full_name(name), wanted);
  std::vector<std::string> words;
  for (int i = 0; i < value.size(); ++i) {
    if (value[i].getType() != XmlRpcValue::TypeString) refuse_parameter(full_name(name), wanted);
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
      const std::string text = format_value(full_name(name), value);
      if (!text.empty()) given.push_back({spec.name, text, "parameter " + full_name(name)});
    }
  }
  return given;
}

/// Returns the names of all existing parameters, without nested names.
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
    throw InputError("parameter " + full_name(own) + ": does not exist." +
                     suggest(own, {known_.begin(), known_.end()}) +
                     " It stays on the parameter server until you run: rosparam delete " +
                     nh_.getNamespace() + "/" + own);
  }
}

bool PrivateParameters::get(const std::string& name, XmlRpcValue& value) {
  known_.insert(name);
  return nh_.getParam(name, value);
}

}  // namespace quadcore::node
