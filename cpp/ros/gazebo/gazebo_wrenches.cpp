#include "gazebo_wrenches.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstdio>

#include "messages.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::node {
namespace {

constexpr double time_rounding = 1e-9;  ///< s
/// Maximum change of the motion by a wrench in one step; a flight counts as diverged at 1000 times
/// as much.
constexpr double max_speed = 1e3;  ///< m/s
constexpr double max_rate = 1e3;   ///< rad/s

void check_size(double size, double max, const char* what, const char* unit) {
  if (size <= max) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "The %s of %g %s is not physical for this vehicle. Give at most %.3g %s.", what,
                size, unit, max, unit);
  throw InputError(text);
}

}  // namespace

void check_wrench(const Simulation& simulation, const messages::Wrench& wrench) {
  if (!wrench.force.allFinite() || !wrench.torque.allFinite()) {
    throw InputError("A force or a torque is not a finite number. Give N and N m.");
  }
  const MassProperties vehicle = mass_properties(simulation.model());
  const double min_inertia = vehicle.inertia_Ccm_F.selfadjointView<Eigen::Lower>().eigenvalues()[0];
  const double dt = simulation.dt();
  check_size(wrench.force.norm(), vehicle.mass * max_speed / dt, "force", "N");
  check_size(wrench.torque.norm(), min_inertia * max_rate / dt, "torque", "N m");
}

PluginElement GazeboWrenches::plugin(const Model& model) {
  const std::string who = "quadcore_node";
  const Vector3d& center = model.links.front().inertial.pose.xyz;
  return {who + "_wrench",
          "libpush_plugin.so",
          {{"topic", topic, who}, {"xyz", format_vector(center), who}},
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
