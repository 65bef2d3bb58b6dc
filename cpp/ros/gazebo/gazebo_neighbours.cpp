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

void GazeboNeighbours::look(const std::vector<std::string>& spaces, bool listen) {
  std::map<std::string, Told> gone;  // subscribers end without the lock that their callbacks take
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    spaces_ = spaces;
    if (!listen) complete_ = false;
    for (auto told = told_.begin(); told != told_.end();) {
      const auto next = std::next(told);
      const bool stays = std::count(spaces.begin(), spaces.end(), told->first) > 0;
      if (!stays || !listen) gone.insert(told_.extract(told));
      told = next;
    }
  }
  if (!listen) return;
  for (const std::string& space : spaces) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (told_.count(space) > 0) continue;
    Told& told = told_[space];
    lock.unlock();
    told.models_subscriber = subscribe(space + "/gazebo/model_states", told.models);
    told.links_subscriber = subscribe(space + "/gazebo/link_states", told.links);
  }
  std::unique_lock<std::mutex> lock(mutex_);
  if (!complete_) act_on_news(std::move(lock));  // who was waited for may have gone
}

bool GazeboNeighbours::all_heard() const {
  return std::all_of(spaces_.begin(), spaces_.end(), [this](const std::string& space) {
    const auto told = told_.find(space);
    return told != told_.end() && !told->second.models.name.empty() &&
           !told->second.links.name.empty();
  });
}

bool GazeboNeighbours::complete() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return complete_ || all_heard();
}

/// The action takes locks of others, so it runs without this one's.
void GazeboNeighbours::act_on_news(std::unique_lock<std::mutex> lock) {
  const bool completes = !complete_ && all_heard();
  complete_ = complete_ || completes;
  if (!complete_ || spaces_.empty() || !when_heard_) return;
  const std::function<void(bool)> action = when_heard_;
  lock.unlock();
  action(completes);
}

void GazeboNeighbours::when_heard(const std::function<void(bool)>& action) {
  const std::lock_guard<std::mutex> lock(mutex_);
  when_heard_ = action;
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
  for (const auto& [space, told] : told_) add(told.models, states);
}

void GazeboNeighbours::add_to(gazebo_msgs::LinkStates& states) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const auto& [space, told] : told_) add(told.links, states);
}

}  // namespace quadcore::node
