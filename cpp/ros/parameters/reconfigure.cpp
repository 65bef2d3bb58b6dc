#include "reconfigure.hpp"

#include <dynamic_reconfigure/ConfigDescription.h>

#include <algorithm>
#include <utility>

#include "quadcore/plugin/error.hpp"

namespace quadcore::node {
namespace {

constexpr const char* only_group = "Default";

dynamic_reconfigure::Group describe_group(const std::vector<Adjustable>& values) {
  dynamic_reconfigure::Group group;
  group.name = only_group;
  for (const Adjustable& value : values) {
    dynamic_reconfigure::ParamDescription parameter;
    parameter.name = value.name;
    parameter.type = value.is_flag ? "bool" : "double";
    parameter.description = value.meaning;
    group.parameters.push_back(parameter);
  }
  return group;
}

bool are_equal(const dynamic_reconfigure::Config& a, const dynamic_reconfigure::Config& b) {
  const auto same = [](const auto& x, const auto& y) { return x.value == y.value; };
  return std::equal(a.bools.begin(), a.bools.end(), b.bools.begin(), b.bools.end(), same) &&
         std::equal(a.doubles.begin(), a.doubles.end(), b.doubles.begin(), b.doubles.end(), same);
}

}  // namespace

Reconfigure::Reconfigure(std::vector<Adjustable> values) : values_(std::move(values)) {
  ros::NodeHandle own("~");
  description_publisher_ =
      own.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", 1, true);
  update_publisher_ = own.advertise<Config>("parameter_updates", 1, true);
  dynamic_reconfigure::ConfigDescription description;
  description.groups.push_back(describe_group(values_));
  description.min = collect([](const Adjustable& value) { return value.min; });
  description.max = collect([](const Adjustable& value) { return value.max; });
  description.dflt = collect([](const Adjustable& value) { return value.get(); });
  description_publisher_.publish(description);
  publish(description.dflt);
  service_ = own.advertiseService("set_parameters", &Reconfigure::set, this);
}

void Reconfigure::update() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Config now = collect([](const Adjustable& value) { return value.get(); });
  if (!are_equal(now, last_)) publish(now);
}

bool Reconfigure::set(dynamic_reconfigure::ReconfigureRequest& request,
                      dynamic_reconfigure::ReconfigureResponse& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  bool is_valid = true;
  try {
    for (const auto& flag : request.config.bools) set(flag.name, true, flag.value);
    for (const auto& number : request.config.doubles) set(number.name, false, number.value);
    if (!request.config.ints.empty() || !request.config.strs.empty()) {
      throw InputError("The values are numbers and flags. Give no others.");
    }
  } catch (const InputError& error) {
    ROS_ERROR("set_parameters: %s", error.what());
    is_valid = false;
  }
  response.config = collect([](const Adjustable& value) { return value.get(); });
  publish(response.config);
  return is_valid;
}

void Reconfigure::set(const std::string& name, bool is_flag, double value) const {
  const auto found =
      std::find_if(values_.begin(), values_.end(), [&](const Adjustable& adjustable) {
        return adjustable.name == name && adjustable.is_flag == is_flag;
      });
  if (found == values_.end()) {
    throw InputError(std::string(is_flag ? "flag '" : "number '") + name +
                     "' does not exist. Read the names on parameter_descriptions.");
  }
  found->set(value);
}

dynamic_reconfigure::Config Reconfigure::collect(
    const std::function<double(const Adjustable&)>& value) const {
  Config config;
  for (const Adjustable& adjustable : values_) {
    if (adjustable.is_flag) {
      config.bools.emplace_back();
      config.bools.back().name = adjustable.name;
      config.bools.back().value = value(adjustable) != 0;
    } else {
      config.doubles.emplace_back();
      config.doubles.back().name = adjustable.name;
      config.doubles.back().value = value(adjustable);
    }
  }
  config.groups.emplace_back();
  config.groups.back().name = only_group;
  config.groups.back().state = true;
  return config;
}

void Reconfigure::publish(const Config& config) {
  last_ = config;
  update_publisher_.publish(config);
}

}  // namespace quadcore::node
