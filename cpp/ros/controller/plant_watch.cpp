#include "plant_watch.hpp"

#include <ros/ros.h>

#include <utility>

namespace quadcore::node {

PlantWatch::PlantWatch(std::string node) : node_(std::move(node)), first_(read_parameters()) {}

bool PlantWatch::has_changed() const {
  const std::string now = read_parameters();
  return !now.empty() && now != first_;
}

/// Reads the parameters of the node and its model, as text.
std::string PlantWatch::read_parameters() const {
  std::string all;
  XmlRpc::XmlRpcValue value;
  if (ros::param::get(node_, value)) all += value.toXml();
  std::string description;
  if (ros::param::search("robot_description", description) &&
      ros::param::get(description, description)) {
    all += description;
  }
  return all;
}

}  // namespace quadcore::node
