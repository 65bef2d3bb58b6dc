#include "path.hpp"

#include "messages.hpp"

namespace quadcore::node {
namespace {

constexpr std::size_t longest_path = 2000;  // poses
/// Removed at once when the path is full, because the rest must be moved.
constexpr std::ptrdiff_t oldest_poses = 200;

}  // namespace

PathTopic::PathTopic(ros::NodeHandle& nh, const std::string& frame)
    : publisher_(nh.advertise<nav_msgs::Path>("path", 10)) {
  path_.header.frame_id = frame;
  path_.poses.reserve(longest_path);
}

void PathTopic::add(const VehicleState& state, const ros::Time& stamp, bool jumped) {
  if (jumped) path_.poses.clear();
  if (!due_.due(stamp.toSec(), jumped)) return;
  if (path_.poses.size() == longest_path) {
    path_.poses.erase(path_.poses.begin(), path_.poses.begin() + oldest_poses);
  }
  path_.header.stamp = stamp;
  path_.poses.emplace_back();
  geometry_msgs::PoseStamped& last = path_.poses.back();
  last.header = path_.header;
  set_vector(last.pose.position, state.position.data());
  set_quaternion(last.pose.orientation, state.orientation.coeffs().data());
  if (publisher_.getNumSubscribers() > 0) publisher_.publish(path_);
}

}  // namespace quadcore::node
