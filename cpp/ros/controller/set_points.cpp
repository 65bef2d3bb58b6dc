#include "set_points.hpp"

#include "messages.hpp"
#include "quadcore/plugin/error.hpp"
#include "references/set_points.hpp"
#include "ros_types.hpp"

namespace quadcore::node {
namespace {

Vector3d check_finite(const char* what, const Vector3d& v) {
  if (!v.allFinite()) {
    throw InputError(std::string(what) +
                     " contains a number that is not finite. Give finite numbers.");
  }
  return v;
}

template <class Vector>
Vector3d check_finite(const char* what, const Vector& v) {
  return check_finite(what, vector_of(v));
}

Quaterniond read_orientation(const char* what, const geometry_msgs::Quaternion& q) {
  const Quaterniond orientation(q.w, q.x, q.y, q.z);
  if (!is_unit(orientation)) {
    throw InputError(std::string(what) +
                     " is not a quaternion of length 1. Give w: 1 for level and forward.");
  }
  return orientation.normalized();
}

double read_yaw(const char* what, const geometry_msgs::Quaternion& q) {
  return rpy_from_quaternion(read_orientation(what, q)).z();
}

double read_thrust(const geometry_msgs::Vector3& thrust) {
  const Vector3d f_F = check_finite("thrust", thrust);
  if (f_F.x() != 0 || f_F.y() != 0) {
    throw InputError("thrust is not along z of the vehicle. Give x and y as 0.");
  }
  return f_F.z();
}

control::PathPoint read_point(const trajectory_msgs::MultiDOFJointTrajectoryPoint& message) {
  if (message.transforms.size() != 1 || message.velocities.size() > 1 ||
      message.accelerations.size() > 1) {
    throw InputError(
        "A point is not valid. Give one transform, and at most one velocity and one acceleration.");
  }
  const auto change = [](const char* what, const std::vector<geometry_msgs::Twist>& twists) {
    std::optional<control::PathPoint::Change> change;
    if (!twists.empty()) {
      change = {check_finite(what, twists[0].linear), check_finite(what, twists[0].angular).z()};
    }
    return change;
  };
  const geometry_msgs::Transform& place = message.transforms[0];
  return {message.time_from_start.toSec(), check_finite("a transform", place.translation),
          read_yaw("rotation", place.rotation), change("a velocity", message.velocities),
          change("an acceleration", message.accelerations)};
}

}  // namespace

SetPoints::SetPoints(ros::NodeHandle& nh, std::string frame, double velocity_timeout,
                     ActiveAim& active_aim)
    : frame_(std::move(frame)), velocity_timeout_(velocity_timeout), active_aim_(active_aim) {
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
          limiter_.warn(name + ": refused: " + error.what());
        }
      };
  subscribers_.push_back(nh.subscribe<Message>(topic, queue_size, callback, ros::VoidConstPtr(),
                                               ros::TransportHints().tcpNoDelay()));
}

void SetPoints::check_frame(const std_msgs::Header& header) const {
  if (header.frame_id.empty() || header.frame_id == frame_) return;
  throw InputError("frame_id is '" + header.frame_id + "'. Give it in '" + frame_ + "'.");
}

void SetPoints::pose(const geometry_msgs::PoseStamped& message) {
  check_frame(message.header);
  control::Reference place;
  place.position = check_finite("position", message.pose.position);
  place.yaw = read_yaw("orientation", message.pose.orientation);
  active_aim_.follow([place](const control::Reference&) { return control::hold(place); });
}

void SetPoints::trajectory(const trajectory_msgs::MultiDOFJointTrajectory& message) {
  check_frame(message.header);
  std::vector<control::PathPoint> points;
  for (const auto& point : message.points) points.push_back(read_point(point));
  control::through({}, points);  // throws errors at once
  active_aim_.follow(
      [points](const control::Reference& from) { return control::through(from, points); });
}

void SetPoints::velocity(const geometry_msgs::Twist& message) {
  const control::Heading heading{check_finite("linear", message.linear),
                                 check_finite("angular", message.angular).z()};
  if (message.angular.x != 0 || message.angular.y != 0) {
    throw InputError("angular is not about z. Give x and y as 0.");
  }
  active_aim_.follow([heading, lasts = velocity_timeout_](const control::Reference& from) {
    return control::drive(from, heading, lasts);
  });
}

void SetPoints::attitude(const AttitudeThrust& message) {
  check_frame(message.header);
  active_aim_.hold(control::AttitudeThrust{read_orientation("attitude", message.attitude),
                                           read_thrust(message.thrust)});
}

void SetPoints::rates(const RateThrust& message) {
  active_aim_.hold(control::RatesThrust{check_finite("angular_rates", message.angular_rates),
                                        read_thrust(message.thrust)});
}

}  // namespace quadcore::node
