#include "gazebo_services.hpp"

#include <gazebo_msgs/ApplyBodyWrench.h>
#include <gazebo_msgs/BodyRequest.h>
#include <gazebo_msgs/GetLinkState.h>
#include <gazebo_msgs/GetModelProperties.h>
#include <gazebo_msgs/GetModelState.h>
#include <gazebo_msgs/GetWorldProperties.h>
#include <gazebo_msgs/SetModelState.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "gazebo_bodies.hpp"
#include "gazebo_physics.hpp"
#include "messages.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::node {
namespace {

void check_model(const std::string& model, const std::string& asked) {
  if (asked != model) {
    throw InputError("model '" + asked + "' does not exist. The model here is " + model + ".");
  }
}

void set_model_state(Simulation& simulation, const std::string& model,
                     const gazebo_msgs::ModelState& wanted) {
  check_model(model, wanted.model_name);
  const BodyMotion other = find_motion(simulation, model, wanted.reference_frame);
  const BodyMotion motion = from_ros(other, wanted.pose, wanted.twist);
  VehicleState state = simulation.state();
  state.position = motion.position;
  state.orientation = motion.orientation;
  state.linear_velocity = motion.linear_velocity;
  state.angular_velocity = motion.orientation.conjugate() * motion.angular_velocity;
  simulation.set_state(state);
}

/// Converts a request to a wrench in the world, about the centre of mass.
messages::Wrench to_wrench(const Simulation& simulation, const std::string& model,
                           const gazebo_msgs::ApplyBodyWrench::Request& request) {
  const BodyMotion other = find_motion(simulation, model, request.reference_frame);
  messages::Wrench wrench;
  wrench.force = other.orientation * vector_of(request.wrench.force);
  wrench.torque = other.orientation * vector_of(request.wrench.torque);
  // As in gazebo_ros, the lever starts at the body's origin, although the force acts at its centre
  // of mass. In the world's axes, the point is not a position but the lever itself.
  Vector3d lever = other.orientation * vector_of(request.reference_point);
  const std::string& frame = request.reference_frame;
  if (!frame.empty() && frame != "world" && frame != "map") {
    lever += other.position - simulation.state().position;
  }
  wrench.torque += lever.cross(wrench.force);
  return wrench;
}

void check_frame(const Simulation& simulation, const std::string& model, const std::string& body) {
  const std::string& frame = simulation.model().links.front().name;
  if (body == frame || body == model + "::" + frame) return;
  find_motion(simulation, model, body);
  throw InputError("'" + body + "' cannot be pushed. Push the frame, " + model + "::" + frame +
                   ".");
}

/// Whether a response has a field for an error; otherwise the call itself fails.
template <class Response>
constexpr bool has_status = true;
template <>
constexpr bool has_status<gazebo_msgs::BodyRequest::Response> = false;

template <class Response>
bool is_success(const Response& response) {
  if constexpr (has_status<Response>) return response.success;
  return true;
}

}  // namespace

GazeboServices::GazeboServices(ros::NodeHandle& nh, const std::string& model, FlightThread& flight,
                               GazeboWrenches& wrenches, const GazeboNeighbours* neighbours)
    : nh_(nh), model_(model), flight_(flight), wrenches_(wrenches), neighbours_(neighbours) {
  offer_states();
  offer_wrenches();
  offer_properties();
}

/// Offers a service of gazebo_ros. In /gazebo, it also serves the neighbours' models: for an
/// unknown model, the node calls their services.
template <class Service, class Act>
void GazeboServices::offer(const std::string& name, const Act& act) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  const auto own = [act, name](Request& request, Response& response) {
    std::optional<std::string> failure;
    try {
      act(request, response);
    } catch (const std::exception& error) {
      failure = error.what();
    }
    if constexpr (has_status<Response>) {
      response.success = !failure;
      response.status_message = failure.value_or("");
    } else if (failure) {
      ROS_ERROR("gazebo/%s: %s", name.c_str(), failure->c_str());
    }
    return !failure;
  };
  const auto answer = [own](Request& request, Response& response) {
    return own(request, response) || has_status<Response>;
  };
  const auto answer_for_all = [this, own, name](Request& request, Response& response) {
    if (own(request, response)) return true;
    for (const std::string& space : neighbours_->spaces()) {
      Response other;
      if (ros::service::call(space + "/gazebo/" + name, request, other) && is_success(other)) {
        response = other;
        return true;
      }
    }
    return has_status<Response>;
  };
  const bool at_root = nh_.getNamespace() == "/";
  if (neighbours_) {
    servers_.push_back(nh_.advertiseService<Request, Response>("/gazebo/" + name, answer_for_all));
  }
  if (!neighbours_ || !at_root) {
    servers_.push_back(nh_.advertiseService<Request, Response>("gazebo/" + name, answer));
  }
}

void GazeboServices::offer_states() {
  offer<gazebo_msgs::GetModelState>("get_model_state", [this](auto& request, auto& response) {
    flight_.run_between_steps([&](const Simulation& simulation) {
      if (request.model_name.rfind("ground_plane", 0) != 0) check_model(model_, request.model_name);
      const BodyMotion model = find_motion(simulation, model_, request.model_name);
      const BodyMotion other = find_motion(simulation, model_, request.relative_entity_name);
      to_ros(express_in(other, model), response.pose, response.twist);
      response.header.stamp = node::to_ros(simulation.time());
      response.header.frame_id = request.relative_entity_name;
    });
  });
  offer<gazebo_msgs::GetLinkState>("get_link_state", [this](auto& request, auto& response) {
    flight_.run_between_steps([&](const Simulation& simulation) {
      const BodyMotion link = find_motion(simulation, model_, request.link_name);
      const BodyMotion other = find_motion(simulation, model_, request.reference_frame);
      gazebo_msgs::LinkState& state = response.link_state;
      to_ros(express_in(other, link), state.pose, state.twist);
      state.link_name = request.link_name;
      state.reference_frame = request.reference_frame;
    });
  });
  offer<gazebo_msgs::SetModelState>("set_model_state", [this](auto& request, auto&) {
    flight_.change(
        [&](Simulation& simulation) { set_model_state(simulation, model_, request.model_state); });
  });
  if (neighbours_) take_states("/gazebo/set_model_state");
  if (!neighbours_ || nh_.getNamespace() != "/") take_states("gazebo/set_model_state");
}

/// Subscribes to the topic with the function of the service of the same name.
void GazeboServices::take_states(const std::string& topic) {
  const std::string service = nh_.resolveName(topic);
  const boost::function<void(const gazebo_msgs::ModelState::ConstPtr&)> take =
      [this, service](const gazebo_msgs::ModelState::ConstPtr& state) {
        gazebo_msgs::SetModelState call;
        call.request.model_state = *state;
        if (!ros::service::call(service, call))
          call.response.status_message = "The node is shutting down.";
        if (!call.response.success) limiter_.warn(service + ": " + call.response.status_message);
      };
  subscribers_.push_back(nh_.subscribe<gazebo_msgs::ModelState>(topic, 1, take));
}

void GazeboServices::offer_wrenches() {
  offer<gazebo_msgs::ApplyBodyWrench>("apply_body_wrench", [this](auto& request, auto&) {
    flight_.run_between_steps([&](const Simulation& simulation) {
      check_frame(simulation, model_, request.body_name);
      const messages::Wrench wrench = to_wrench(simulation, model_, request);
      check_wrench(simulation, wrench);
      const double duration = request.duration.toSec();
      if (duration == 0) return;  // like gazebo_ros
      const double begin = std::max(request.start_time.toSec(), simulation.time());
      wrenches_.add(wrench, begin, duration < 0 ? INFINITY : begin + duration);
    });
  });
  offer<gazebo_msgs::BodyRequest>("clear_body_wrenches", [this](auto& request, auto&) {
    flight_.run_between_steps([&](const Simulation& simulation) {
      check_frame(simulation, model_, request.body_name);
      wrenches_.clear();
    });
  });
}

void GazeboServices::offer_properties() {
  offer<gazebo_msgs::GetPhysicsProperties>("get_physics_properties", [this](auto&, auto& response) {
    flight_.run_between_steps([&](const Simulation& simulation) {
      describe_physics(simulation, flight_.report(), response);
    });
  });
  offer<gazebo_msgs::SetPhysicsProperties>("set_physics_properties", [this](auto& request, auto&) {
    flight_.run_between_steps(
        [&](const Simulation& simulation) { check_physics(simulation, request); });
    flight_.set_real_time_factor(compute_real_time_factor(request));
  });
  offer<gazebo_msgs::GetWorldProperties>("get_world_properties", [this](auto&, auto& response) {
    flight_.run_between_steps([&](const Simulation& simulation) {
      response.sim_time = simulation.time();
      if (simulation.world().ground_plane) response.model_names.push_back("ground_plane");
      response.model_names.push_back(model_);
    });
    if (!neighbours_) return;
    for (const std::string& space : neighbours_->spaces()) {
      gazebo_msgs::GetWorldProperties other;
      if (!ros::service::call(space + "/gazebo/get_world_properties", other)) continue;
      for (const std::string& name : other.response.model_names) {
        if (name != "ground_plane") response.model_names.push_back(name);
      }
    }
  });
  offer<gazebo_msgs::GetModelProperties>(
      "get_model_properties", [this](auto& request, auto& response) {
        flight_.run_between_steps([&](const Simulation& simulation) {
          check_model(model_, request.model_name);
          for (const Link& link : simulation.model().links) {
            response.body_names.push_back(link.name);
          }
          response.canonical_body_name = response.body_names.front();
          response.joint_names = simulation.rotor_names();
        });
      });
}

}  // namespace quadcore::node
