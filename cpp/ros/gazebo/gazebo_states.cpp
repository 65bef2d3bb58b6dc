#include "gazebo_states.hpp"

#include <vector>

#include "gazebo_bodies.hpp"
#include "messages.hpp"

namespace quadcore::node {
namespace {

bool has_listener(const ros::Publisher& publisher) {
  return publisher && publisher.getNumSubscribers() > 0;
}

/// Writes the last `count` states.
template <class States>
void fill(const std::vector<BodyMotion>& bodies, std::size_t count, States& states) {
  const std::size_t before = states.name.size() - count;
  for (std::size_t i = 0; i < count; ++i) {
    to_ros(bodies[i], states.pose[before + i], states.twist[before + i]);
  }
}

/// Resizes the states to the number of names.
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
  if (simulation.world().ground_plane) {
    models_.states.name.push_back("ground_plane");
    links_.states.name.push_back("ground_plane::link");
  }
  models_.states.name.push_back(model);
  for (const Link& link : simulation.model().links) {
    links_.states.name.push_back(model + "::" + link.name);
  }
  make_room(models_.states);
  make_room(links_.states);
  advertise(nh, "gazebo/model_states", models_);
  advertise(nh, "gazebo/link_states", links_);
}

template <class States>
void GazeboStates::advertise(ros::NodeHandle& nh, const std::string& name, Sent<States>& sent) {
  const auto on_newcomer = [this](const ros::SingleSubscriberPublisher&) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (for_newcomers_) for_newcomers_();
  };
  if (neighbours_) sent.of_all = nh.advertise<States>("/" + name, queue_size, on_newcomer);
  if (neighbours_ && nh.getNamespace() == "/") return;
  sent.own = nh.advertise<States>(name, queue_size, on_newcomer);
}

void GazeboStates::for_newcomers(const std::function<void()>& action) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for_newcomers_ = action;
}

bool GazeboStates::asks_neighbours() const {
  return has_listener(models_.of_all) || has_listener(links_.of_all);
}

void GazeboStates::send(const Simulation& simulation) {
  const auto is_wanted = [](const auto& sent) {
    return has_listener(sent.own) || has_listener(sent.of_all);
  };
  if (!is_wanted(models_) && !is_wanted(links_)) return;
  const std::vector<BodyMotion> bodies = compute_body_motions(simulation);
  fill(bodies, 1, models_.states);
  fill(bodies, bodies.size(), links_.states);
  publish(models_);
  publish(links_);
}

template <class States>
void GazeboStates::publish(Sent<States>& sent) {
  if (has_listener(sent.own)) sent.own.publish(sent.states);
  if (!has_listener(sent.of_all) || !neighbours_->is_complete()) return;
  States all = sent.states;
  neighbours_->add_to(all);
  sent.of_all.publish(all);
}

}  // namespace quadcore::node
