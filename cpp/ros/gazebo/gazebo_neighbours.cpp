#include "gazebo_neighbours.hpp"

#include <algorithm>
#include <utility>

namespace quadcore::node {
namespace {

template <class States>
void add(const States& more, States& states) {
  for (std::size_t i = 0; i < more.name.size(); ++i) {
    if (std::count(states.name.begin(), states.name.end(), more.name[i]) > 0) continue;  // ground
    states.name.push_back(more.name[i]);
    states.pose.push_back(more.pose[i]);
    states.twist.push_back(more.twist[i]);
  }
}

}  // namespace

void GazeboNeighbours::update(const std::vector<std::string>& spaces, bool listen) {
  std::map<std::string, Neighbour> gone;  // destroyed without the lock that their callbacks take
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    spaces_ = spaces;
    if (!listen) complete_ = false;
    for (auto neighbour = neighbours_.begin(); neighbour != neighbours_.end();) {
      const auto next = std::next(neighbour);
      const bool stays = std::count(spaces.begin(), spaces.end(), neighbour->first) > 0;
      if (!stays || !listen) gone.insert(neighbours_.extract(neighbour));
      neighbour = next;
    }
  }
  if (!listen) return;
  for (const std::string& space : spaces) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (neighbours_.count(space) > 0) continue;
    Neighbour& neighbour = neighbours_[space];
    lock.unlock();
    neighbour.models_subscriber = subscribe(space + "/gazebo/model_states", neighbour.models);
    neighbour.links_subscriber = subscribe(space + "/gazebo/link_states", neighbour.links);
  }
  std::unique_lock<std::mutex> lock(mutex_);
  if (!complete_) act_on_news(std::move(lock));  // a missing neighbour may have ended
}

bool GazeboNeighbours::has_heard_all() const {
  return std::all_of(spaces_.begin(), spaces_.end(), [this](const std::string& space) {
    const auto neighbour = neighbours_.find(space);
    return neighbour != neighbours_.end() && !neighbour->second.models.name.empty() &&
           !neighbour->second.links.name.empty();
  });
}

bool GazeboNeighbours::is_complete() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return complete_ || has_heard_all();
}

/// The action takes other locks, so it runs without this one.
void GazeboNeighbours::act_on_news(std::unique_lock<std::mutex> lock) {
  const bool completes = !complete_ && has_heard_all();
  complete_ = complete_ || completes;
  if (!complete_ || spaces_.empty() || !on_message_) return;
  const std::function<void(bool)> action = on_message_;
  lock.unlock();
  action(completes);
}

void GazeboNeighbours::on_message(const std::function<void(bool)>& action) {
  const std::lock_guard<std::mutex> lock(mutex_);
  on_message_ = action;
}

template <class States>
ros::Subscriber GazeboNeighbours::subscribe(const std::string& topic, States& newest) {
  const boost::function<void(const boost::shared_ptr<const States>&)> take =
      [this, &newest](const boost::shared_ptr<const States>& states) {
        std::unique_lock<std::mutex> lock(mutex_);
        newest = *states;
        act_on_news(std::move(lock));
      };
  return nh_.subscribe<States>(topic, 1, take);
}

std::vector<std::string> GazeboNeighbours::spaces() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return spaces_;
}

void GazeboNeighbours::add_to(gazebo_msgs::ModelStates& states) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const auto& [space, neighbour] : neighbours_) add(neighbour.models, states);
}

void GazeboNeighbours::add_to(gazebo_msgs::LinkStates& states) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const auto& [space, neighbour] : neighbours_) add(neighbour.links, states);
}

}  // namespace quadcore::node
