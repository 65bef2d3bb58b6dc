#pragma once

#include <gazebo_msgs/LinkStates.h>
#include <gazebo_msgs/ModelStates.h>
#include <ros/ros.h>

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace quadcore::node {

/// The nodes that follow this one's clock, each of which tells of its own model in its namespace:
/// to gazebo_ros' clients all are models of one world.
class GazeboNeighbours {
 public:
  explicit GazeboNeighbours(const ros::NodeHandle& nh) : nh_(nh) {}

  /// What is done, in any thread, with each message of a neighbour from the moment on at which all
  /// have been heard. The argument: whether this is that moment.
  void when_heard(const std::function<void(bool)>& action);

  /// Who they are now, by namespace.
  /// \param listen  whether to hear where their models are
  void look(const std::vector<std::string>& spaces, bool listen);
  std::vector<std::string> spaces() const;
  /// Whether each has been heard since somebody listens, so that no model is missing.
  bool complete() const;
  /// Adds what they told last.
  void add_to(gazebo_msgs::ModelStates& states) const;
  void add_to(gazebo_msgs::LinkStates& states) const;

 private:
  struct Told {
    gazebo_msgs::ModelStates models;
    gazebo_msgs::LinkStates links;
    ros::Subscriber models_subscriber, links_subscriber;  // which end before what they fill
  };
  template <class States>
  ros::Subscriber subscribe(const std::string& topic, States& newest);
  bool all_heard() const;
  void act_on_news(std::unique_lock<std::mutex> lock);

  ros::NodeHandle nh_;
  mutable std::mutex mutex_;
  std::function<void(bool)> when_heard_;
  bool complete_ = false;
  std::vector<std::string> spaces_;
  std::map<std::string, Told> told_;  ///< by namespace
};

}  // namespace quadcore::node
