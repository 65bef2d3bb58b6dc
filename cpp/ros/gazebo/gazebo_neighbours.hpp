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

/// The nodes that follow this node's clock. Each publishes its model in its namespace; for clients
/// of gazebo_ros, all are models of one world.
class GazeboNeighbours {
 public:
  explicit GazeboNeighbours(const ros::NodeHandle& nh) : nh_(nh) {}

  /// Sets an action that runs, in any thread, for each message of a neighbour after all have sent
  /// one. Its argument: whether this message completes the set.
  void on_message(const std::function<void(bool)>& action);

  /// Sets the present neighbours by namespace.
  /// \param listen  whether to subscribe to their states
  void update(const std::vector<std::string>& spaces, bool listen);
  std::vector<std::string> spaces() const;
  /// Whether every neighbour has sent its state since listening began.
  bool is_complete() const;
  /// Adds their last states.
  void add_to(gazebo_msgs::ModelStates& states) const;
  void add_to(gazebo_msgs::LinkStates& states) const;

 private:
  struct Neighbour {
    gazebo_msgs::ModelStates models;
    gazebo_msgs::LinkStates links;
    ros::Subscriber models_subscriber,
        links_subscriber;  // destroyed before the data that they fill
  };
  template <class States>
  ros::Subscriber subscribe(const std::string& topic, States& newest);
  bool has_heard_all() const;
  void act_on_news(std::unique_lock<std::mutex> lock);

  ros::NodeHandle nh_;
  mutable std::mutex mutex_;
  std::function<void(bool)> on_message_;
  bool complete_ = false;
  std::vector<std::string> spaces_;
  std::map<std::string, Neighbour> neighbours_;  ///< by namespace
};

}  // namespace quadcore::node
