#include "services.hpp"

#include <quadcore/SetState.h>
#include <quadcore/Step.h>
#include <std_srvs/Empty.h>

#include <cmath>
#include <cstdio>

#include "quadcore/plugin/error.hpp"
#include "respond.hpp"
#include "topic_services.hpp"

namespace quadcore::node {
namespace {

/// Tolerance of a quaternion's length, for numbers with four digits or single precision.
constexpr double unit_tolerance = 1e-3;

/// One more than the two topics that are answered by a service call.
constexpr std::uint32_t threads = 3;

void reset_simulation(Simulation& simulation) { simulation.reset(); }

/// Resets everything except the time, which continues.
void reset_world(Simulation& simulation) {
  const double now = simulation.time();
  simulation.reset();
  VehicleState start = simulation.state();
  start.time = now;
  simulation.set_state(start);
}

void set_state(const SetState::Request& request, Simulation& simulation) {
  VehicleState state = simulation.state();
  const auto& p = request.pose.position;
  const auto& q = request.pose.orientation;
  const auto& v = request.twist.linear;
  const auto& w = request.twist.angular;
  state.position = {p.x, p.y, p.z};
  state.orientation = Quaterniond(q.w, q.x, q.y, q.z);
  const double length = state.orientation.norm();
  if (std::abs(length - 1) > unit_tolerance) {
    char text[100];
    std::snprintf(text, sizeof text, "state: the orientation is a quaternion of length %g", length);
    throw InputError(std::string(text) + ". Give one of length 1.");
  }
  state.linear_velocity = {v.x, v.y, v.z};
  state.angular_velocity = {w.x, w.y, w.z};
  if (!request.rotor_velocity.empty()) {
    state.rotor_velocity = Eigen::Map<const VectorXd>(
        request.rotor_velocity.data(), static_cast<Eigen::Index>(request.rotor_velocity.size()));
  }
  simulation.set_state(state);
}

}  // namespace

Services::Services(const ros::NodeHandle& nh, const Simulation& simulation, FlightThread& flight,
                   const std::string& model, GazeboWrenches& wrenches,
                   const GazeboNeighbours* neighbours)
    : nh_(nh), spinner_(threads, &queue_) {
  nh_.setCallbackQueue(&queue_);
  // In a namespace, other vehicles share the clock.
  const bool at_root = nh.getNamespace() == "/";
  const bool own_clock = neighbours && at_root;
  using Empty = std_srvs::Empty;
  // std_srvs/Empty has no error message: a call that returns false fails.
  const auto offer = [&](const std::string& name, const std::function<void()>& action) {
    servers_.push_back(nh_.advertiseService<Empty::Request, Empty::Response>(
        name, [name, action](Empty::Request&, Empty::Response&) {
          try {
            action();
          } catch (const std::exception& error) {
            ROS_ERROR("%s: %s", name.c_str(), error.what());
            return false;
          }
          return true;
        }));
  };
  offer("gazebo/pause_physics", [&flight] { flight.set_paused(true); });
  offer("gazebo/unpause_physics", [&flight] { flight.set_paused(false); });
  if (neighbours && !at_root) {  // the leader of the clock serves all followers
    offer("/gazebo/pause_physics", [&flight] { flight.set_paused(true); });
    offer("/gazebo/unpause_physics", [&flight] { flight.set_paused(false); });
    for (const char* const reset : {"gazebo/reset_simulation", "gazebo/reset_world"}) {
      offer(std::string("/") + reset, [&flight, neighbours, reset] {
        flight.reset(reset_world);
        for (const std::string& space : neighbours->spaces()) {
          std_srvs::Empty empty;
          if (!ros::service::call(space + "/" + reset, empty)) {
            throw InputError(space + " was not reset. Reset it again.");
          }
        }
      });
    }
  }
  offer("gazebo/reset_simulation",
        [&flight, own_clock] { flight.reset(own_clock ? reset_simulation : reset_world); });
  offer("gazebo/reset_world", [&flight] { flight.reset(reset_world); });

  const auto of_topics = offer_topics(nh_, simulation.topics(),
                                      {Simulation::command_topic, GazeboWrenches::topic}, flight);
  servers_.insert(servers_.end(), of_topics.begin(), of_topics.end());
  gazebo_.emplace(nh_, model, flight, wrenches, neighbours);
  servers_.insert(servers_.end(), gazebo_->servers().begin(), gazebo_->servers().end());
  // Last, so that a node that waits for one of them finds all other services.
  servers_.push_back(nh_.advertiseService<Step::Request, Step::Response>(
      "quadcore/step", [&flight](Step::Request& request, Step::Response& response) {
        respond(response, [&] { flight.step(request.n); });
        response.stamp.fromSec(flight.report().time);
        return true;
      }));
  servers_.push_back(nh_.advertiseService<SetState::Request, SetState::Response>(
      "quadcore/set_state", [&flight](SetState::Request& request, SetState::Response& response) {
        respond(response, [&] {
          flight.change([&](Simulation& simulation) { set_state(request, simulation); });
        });
        return true;
      }));
  spinner_.start();
}

std::vector<std::string> Services::names() const {
  std::vector<std::string> names;
  for (const ros::ServiceServer& server : servers_) names.push_back(server.getService());
  return names;
}

}  // namespace quadcore::node
