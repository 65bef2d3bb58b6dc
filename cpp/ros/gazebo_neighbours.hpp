#pragma once

#include <gazebo_msgs/LinkStates.h>
#include <gazebo_msgs/ModelStates.h>
#include <ros/ros.h>

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

  /// Who they are now, by namespace.
  /// \param listen  whether to hear where their models are
  void look(const std::vector<std::string>& spaces, bool listen);
  std::vector<std::string> spaces() const;
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

  ros::NodeHandle nh_;
  mutable std::mutex mutex_;
  std::vector<std::string> spaces_;
  std::map<std::string, Told> told_;  ///< by namespace
};

}  // namespace quadcore::node
