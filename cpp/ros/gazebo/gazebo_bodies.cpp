#include "gazebo_bodies.hpp"

#include "messages.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore::node {
namespace {

/// Returns the motion of a point fixed to a body, with its position and attitude there.
BodyMotion attach(const BodyMotion& body, const Vector3d& place, const Quaterniond& turn) {
  BodyMotion motion = body;
  const Vector3d arm = body.orientation * place;
  motion.position += arm;
  motion.orientation = body.orientation * turn;
  motion.linear_velocity += body.angular_velocity.cross(arm);
  return motion;
}

}  // namespace

std::vector<BodyMotion> compute_body_motions(const Simulation& simulation) {
  const VehicleState& state = simulation.state();
  const Model& model = simulation.model();
  std::vector<BodyMotion> bodies = {{state.position, state.orientation, state.linear_velocity,
                                     state.orientation * state.angular_velocity}};
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    const auto row = static_cast<Eigen::Index>(i);
    const Quaterniond turn =
        joint.pose.rotation() * Quaterniond(Eigen::AngleAxisd(state.rotor_angle[row], joint.axis));
    BodyMotion body = attach(bodies[joint.parent], joint.pose.xyz, turn);
    body.angular_velocity += state.rotor_velocity[row] * (body.orientation * joint.axis);
    bodies.push_back(body);
  }
  return bodies;
}

BodyMotion find_motion(const Simulation& simulation, const std::string& model,
                       const std::string& entity) {
  const std::string ground = "ground_plane";
  if (entity.empty() || entity == "world" || entity == "map") return {};
  if (simulation.world().ground_plane && entity.rfind(ground, 0) == 0) return {};
  const std::vector<BodyMotion> bodies = compute_body_motions(simulation);
  if (entity == model) return bodies.front();
  const std::string scope = model + "::";
  const std::string link = entity.rfind(scope, 0) == 0 ? entity.substr(scope.size()) : entity;
  const auto body = simulation.model().body_of_link.find(link);
  if (body == simulation.model().body_of_link.end()) {
    std::vector<std::string> names = {model};
    for (const auto& known : simulation.model().body_of_link) names.push_back(scope + known.first);
    throw InputError("'" + entity + "' does not exist. Choose one of world, " + joined(names) +
                     ".");
  }
  const Pose& place = simulation.model().pose_of_link.at(link);
  return attach(bodies[body->second], place.xyz, place.rotation());
}

BodyMotion express_in(const BodyMotion& other, const BodyMotion& body) {
  const Quaterniond back = other.orientation.conjugate();
  return {back * (body.position - other.position), back * body.orientation,
          back * (body.linear_velocity - other.linear_velocity),
          back * (body.angular_velocity - other.angular_velocity)};
}

void to_ros(const BodyMotion& motion, geometry_msgs::Pose& pose, geometry_msgs::Twist& twist) {
  set_vector(pose.position, motion.position.data());
  set_quaternion(pose.orientation, motion.orientation.coeffs().data());
  set_vector(twist.linear, motion.linear_velocity.data());
  set_vector(twist.angular, motion.angular_velocity.data());
}

BodyMotion from_ros(const BodyMotion& other, const geometry_msgs::Pose& pose,
                    const geometry_msgs::Twist& twist) {
  const geometry_msgs::Quaternion& q = pose.orientation;
  Quaterniond turn(q.w, q.x, q.y, q.z);
  if (turn.coeffs().isZero(0)) turn = Quaterniond::Identity();
  return {other.position + other.orientation * vector_of(pose.position),
          other.orientation * turn.normalized(), other.orientation * vector_of(twist.linear),
          other.orientation * vector_of(twist.angular)};
}

}  // namespace quadcore::node
