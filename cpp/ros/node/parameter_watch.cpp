#include "parameter_watch.hpp"

#include <utility>

#include "master_api.hpp"
#include "private_parameters.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::node {

using XmlRpc::XmlRpcValue;

ParameterWatch::ParameterWatch(FlightThread& flight, bool follows_clock, Values known)
    : flight_(flight), follows_clock_(follows_clock), last_(std::move(known)) {}

ParameterWatch::Values ParameterWatch::read() {
  Values values;
  XmlRpcValue all;
  // Not ros::param::get, which waits for a missing master.
  if (!call_master("getParam", {ros::this_node::getName()}, all)) return values;
  if (all.getType() != XmlRpcValue::TypeStruct) return values;
  for (const auto& [name, value] : all) values.emplace(name, value);
  return values;
}

void ParameterWatch::poll() {
  Values now = read();
  for (const auto& [name, value] : now) {
    const auto before = last_.find(name);
    if (before != last_.end() && before->second == value) continue;
    try {
      apply(name, value);
    } catch (const InputError& error) {
      ROS_WARN("%s", error.what());
    }
  }
  last_ = std::move(now);
}

void ParameterWatch::apply(const std::string& name, const XmlRpcValue& value) {
  if (name == "paused") {
    flight_.set_paused(to_flag(name, value));
  } else if (name == "real_time_factor" && follows_clock_) {
    throw InputError(
        "parameter ~real_time_factor: has no effect on a follower of /clock. Set it for the "
        "leader.");
  } else if (name == "real_time_factor") {
    flight_.set_real_time_factor(to_non_negative(name, value));
  } else {
    throw InputError("parameter ~" + name +
                     ": has no effect during a flight; only paused and real_time_factor have. "
                     "Restart the node.");
  }
}

}  // namespace quadcore::node
