#include "gazebo_wrenches.hpp"

#include <algorithm>
#include <cstdio>

namespace quadcore::node {
namespace {

constexpr double time_rounding = 1e-9;  ///< s

std::string written(const Vector3d& vector) {
  std::string text;
  for (int i = 0; i < 3; ++i) {
    char number[40];
    std::snprintf(number, sizeof number, "%s%.17g", i ? " " : "", vector[i]);
    text += number;
  }
  return text;
}

}  // namespace

PluginElement GazeboWrenches::plugin(const Model& model) {
  const std::string who = "quadcore_node";
  const Vector3d& center = model.links.front().inertial.pose.xyz;
  return {who + "_wrench",
          "libpush_plugin.so",
          {{"topic", topic, who}, {"xyz", written(center), who}},
          who};
}

void GazeboWrenches::add(const messages::Wrench& wrench, double begin, double end) {
  const std::lock_guard<std::mutex> lock(mutex_);
  wrenches_.push_back({wrench, begin, end});
}

void GazeboWrenches::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  wrenches_.clear();
}

void GazeboWrenches::act(Simulation& simulation) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (wrenches_.empty() && !acts_) return;
  const double now = simulation.time();
  const auto is_over = [now](const Wrench& w) {
    return w.has_acted && now >= w.end - time_rounding;
  };
  wrenches_.erase(std::remove_if(wrenches_.begin(), wrenches_.end(), is_over), wrenches_.end());
  messages::Wrench sum;
  acts_ = false;
  for (Wrench& wrench : wrenches_) {
    if (now < wrench.begin - time_rounding) continue;
    wrench.has_acted = acts_ = true;
    sum.force += wrench.wrench.force;
    sum.torque += wrench.wrench.torque;
  }
  std::vector<double> row(messages::kind_of<messages::Wrench>().fields.size());
  messages::write(sum, row.data());
  simulation.publish(topic, row.data(), row.size());
}

}  // namespace quadcore::node
