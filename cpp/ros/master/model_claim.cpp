#include "model_claim.hpp"

#include <std_msgs/String.h>

#include "master_api.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::node {

// The master lists the publishers of a topic in the order of registration, so the first one has the
// claim.
ros::Publisher claim_model(ros::NodeHandle& nh, const std::string& model) {
  constexpr bool kept = true;
  const std::string topic = "/gazebo/models/" + model;
  const ros::Publisher claim = nh.advertise<std_msgs::String>(topic, 1, kept);
  const std::string other = find_earlier_publisher(topic);
  if (!other.empty()) {
    throw InputError("parameter ~name: " + other + " already simulates a model '" + model +
                     "'. Give this one another name, with roslaunch name:=NAME.");
  }
  std_msgs::String owner;
  owner.data = ros::this_node::getName();
  claim.publish(owner);
  return claim;
}

}  // namespace quadcore::node
