#include "gazebo_states.hpp"

#include "gazebo_bodies.hpp"
#include "messages.hpp"

namespace quadcore::node {
namespace {

template <class States>
void fill(const std::vector<BodyMotion>& bodies, std::size_t count, States& states) {
  const std::size_t before = states.name.size() - count;
  for (std::size_t i = 0; i < count; ++i) {
    to_ros(bodies[i], states.pose[before + i], states.twist[before + i]);
  }
}

/// With room for all that is named.
template <class States>
void make_room(States& states) {
  states.pose.resize(states.name.size());
  states.twist.resize(states.name.size());
  for (geometry_msgs::Pose& pose : states.pose) pose.orientation.w = 1;
}

}  // namespace

GazeboStates::GazeboStates(ros::NodeHandle& nh, const Simulation& simulation,
                           const std::string& model, const GazeboNeighbours* neighbours)
    : neighbours_(neighbours) {
  if (neighbours) {
    all_models_publisher_ = {nh, "/gazebo/model_states", queue_size};
    all_links_publisher_ = {nh, "/gazebo/link_states", queue_size};
  }
  if (!neighbours || nh.getNamespace() != "/") {
    model_publisher_ = {nh, "gazebo/model_states", queue_size};
    link_publisher_ = {nh, "gazebo/link_states", queue_size};
  }
  if (simulation.world().ground_plane) {
    models_.name.push_back("ground_plane");
    links_.name.push_back("ground_plane::link");
  }
  models_.name.push_back(model);
  for (const Link& link : simulation.model().links) {
    links_.name.push_back(model + "::" + link.name);
  }
  make_room(models_);
  make_room(links_);
}

void GazeboStates::send(const Simulation& simulation) {
  const std::vector<BodyMotion> bodies = body_motions(simulation);
  fill(bodies, 1, models_);
  fill(bodies, bodies.size(), links_);
  if (model_publisher_) model_publisher_.publish(models_);
  if (link_publisher_) link_publisher_.publish(links_);
  if (!neighbours_) return;
  gazebo_msgs::ModelStates all_models = models_;
  gazebo_msgs::LinkStates all_links = links_;
  neighbours_->add_to(all_models);
  neighbours_->add_to(all_links);
  all_models_publisher_.publish(all_models);
  all_links_publisher_.publish(all_links);
}

}  // namespace quadcore::node
