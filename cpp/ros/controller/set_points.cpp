#include "set_points.hpp"

#include "messages.hpp"
#include "quadcore/plugin/error.hpp"
#include "references/set_points.hpp"
#include "ros_types.hpp"

namespace quadcore::node {
namespace {

Vector3d finite(const char* what, const Vector3d& v) {
  if (!v.allFinite()) {
    throw InputError(std::string(what) + " holds a number that is not finite; give finite ones");
  }
  return v;
}

template <class Vector>
Vector3d finite(const char* what, const Vector& v) {
  return finite(what, vector_of(v));
}

Quaterniond orientation_of(const char* what, const geometry_msgs::Quaternion& q) {
  const Quaterniond orientation(q.w, q.x, q.y, q.z);
  if (!is_unit(orientation)) {
    throw InputError(std::string(what) + " is no quaternion of length 1; w: 1 is level, ahead");
  }
  return orientation.normalized();
}

double yaw_of(const char* what, const geometry_msgs::Quaternion& q) {
  return rpy_from_quaternion(orientation_of(what, q)).z();
}

void check_frame(const std_msgs::Header& header) {
  if (header.frame_id.empty() || header.frame_id == world_frame) return;
  throw InputError("frame_id is '" + header.frame_id + "'; give it in '" + world_frame + "'");
}

double thrust_of(const geometry_msgs::Vector3& thrust) {
  const Vector3d f_F = finite("thrust", thrust);
  if (f_F.x() != 0 || f_F.y() != 0) {
    throw InputError("thrust is not along z of the vehicle; give x and y as 0");
  }
  return f_F.z();
}

control::PathPoint point_of(const trajectory_msgs::MultiDOFJointTrajectoryPoint& message) {
  if (message.transforms.size() != 1 || message.velocities.size() > 1 ||
      message.accelerations.size() > 1) {
    throw InputError("a point has not one transform, and one velocity and acceleration at most");
  }
  const auto change = [](const char* what, const std::vector<geometry_msgs::Twist>& twists) {
    std::optional<control::PathPoint::Change> change;
    if (!twists.empty()) {
      change = {finite(what, twists[0].linear), finite(what, twists[0].angular).z()};
    }
    return change;
  };
  const geometry_msgs::Transform& place = message.transforms[0];
  return {message.time_from_start.toSec(), finite("a transform", place.translation),
          yaw_of("rotation", place.rotation), change("a velocity", message.velocities),
          change("an acceleration", message.accelerations)};
}

}  // namespace

SetPoints::SetPoints(ros::NodeHandle& nh, double velocity_timeout, Guide& guide)
    : velocity_timeout_(velocity_timeout), guide_(guide) {
  take(nh, "command/pose", &SetPoints::pose);
  take(nh, "command/trajectory", &SetPoints::trajectory);
  take(nh, "command/velocity", &SetPoints::velocity);
  take(nh, "command/attitude_thrust", &SetPoints::attitude);
  take(nh, "command/rate_thrust", &SetPoints::rates);
}

template <class Message>
void SetPoints::take(ros::NodeHandle& nh, const std::string& topic,
                     void (SetPoints::*act)(const Message& message)) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
      [this, act, name = nh.resolveName(topic)](const boost::shared_ptr<const Message>& message) {
        try {
          (this->*act)(*message);
        } catch (const InputError& error) {
          sayer_.warn(name + ": refused: " + error.what());
        }
      };
  subscribers_.push_back(nh.subscribe<Message>(topic, queue_size, callback, ros::VoidConstPtr(),
                                               ros::TransportHints().tcpNoDelay()));
}

void SetPoints::pose(const geometry_msgs::PoseStamped& message) {
  check_frame(message.header);
  control::Reference place;
  place.position = finite("position", message.pose.position);
  place.yaw = yaw_of("orientation", message.pose.orientation);
  guide_.follow([place](const control::Reference&) { return control::hold(place); });
}

void SetPoints::trajectory(const trajectory_msgs::MultiDOFJointTrajectory& message) {
  check_frame(message.header);
  std::vector<control::PathPoint> points;
  for (const auto& point : message.points) points.push_back(point_of(point));
  control::through({}, points);  // what is wrong with it is told now
  guide_.follow(
      [points](const control::Reference& from) { return control::through(from, points); });
}

void SetPoints::velocity(const geometry_msgs::Twist& message) {
  const control::Heading heading{finite("linear", message.linear),
                                 finite("angular", message.angular).z()};
  if (message.angular.x != 0 || message.angular.y != 0) {
    throw InputError("angular is not about z; give x and y as 0");
  }
  guide_.follow([heading, lasts = velocity_timeout_](const control::Reference& from) {
    return control::drive(from, heading, lasts);
  });
}

void SetPoints::attitude(const AttitudeThrust& message) {
  check_frame(message.header);
  guide_.hold(control::AttitudeThrust{orientation_of("attitude", message.attitude),
                                      thrust_of(message.thrust)});
}

void SetPoints::rates(const RateThrust& message) {
  guide_.hold(control::RatesThrust{finite("angular_rates", message.angular_rates),
                                   thrust_of(message.thrust)});
}

}  // namespace quadcore::node
