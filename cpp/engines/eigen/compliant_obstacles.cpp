#include "compliant_obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "contact_surface.hpp"
#include "laws/ahead.hpp"
#include "lowest_point.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/world.hpp"
#include "shortest_rotation.hpp"
#include "surface_points.hpp"

namespace quadcore {
namespace {

/// Maximum number of obstacles that press on one point. The springs are softer, so that these and
/// one friction are stable together.
constexpr std::size_t most_obstacles_at_once = 3;
constexpr double shared_stiffness = 1.0 / (most_obstacles_at_once + 1);
/// Cosine of the angle from which on a normal is opposite to the axis of friction. It is well
/// beyond a right angle, so that the normals of a floor and a wall are not.
constexpr double turned_round = -0.5;
/// Length of the mean of unit normals below which it has no direction.
constexpr double smallest_mean_normal = 1e-6;

void refuse_meshes(const std::vector<Obstacle>& obstacles) {
  for (const Obstacle& obstacle : obstacles) {
    if (obstacle.kind != ShapeKind::mesh) continue;
    throw InputError(obstacle.where + ": the engine eigen does not model the mesh of '" +
                     obstacle.model + "'. Use the engine ode or gazebo11.");
  }
}

std::vector<Vector3d> place_spread_points(const Collision& shape, const Vector3d& p_CS,
                                          const Matrix3d& R_CS) {
  std::vector<Vector3d> points;
  for (const Vector3d& p_S : spread_points(shape)) points.push_back(p_CS + R_CS * p_S);
  return points;
}

}  // namespace

CompliantObstacles::CompliantObstacles(const Model& model, const Gyrostat& body,
                                       std::vector<Obstacle> obstacles)
    : model_(model),
      weight_(World{}.gravity_W.norm() / body.inverse_mass),
      reach_(find_reach(model, body)),
      obstacles_(std::move(obstacles)),
      clear_(obstacles_) {
  check_collisions(model);
  refuse_meshes(obstacles_);
  const std::vector<StableContact> stable = stable_contacts(model, body, place_spread_points);
  const std::vector<Eigen::Isometry3d> poses = link_poses(model);
  std::size_t most_points = 0;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    for (const Collision& collision : model.links[i].collisions) {
      Shape shape;
      shape.link = i;
      shape.collision = &collision;
      shape.points_S = spread_points(collision);
      shape.R_FL_at_zero = poses[i].linear();
      shape.R_LS = collision.pose.rotation().toRotationMatrix();
      shape.radius = collision.kind == ShapeKind::sphere ? collision.size.x() : 0;
      shape.reach = outer_radius(collision.kind, collision.size);
      shape.revolves = i > 0 && revolves(model, i, collision);
      shape.stable = stable[shapes_.size()];
      shape.stable.pressing *= shared_stiffness;
      shape.stable.rubbing *= shared_stiffness;
      most_points = std::max(most_points, shape.points_S.size());
      shapes_.push_back(shape);
    }
  }
  // No step allocates memory.
  near_.reserve(obstacles_.size());
  near_shape_.reserve(obstacles_.size());
  points_.reserve(most_points * most_obstacles_at_once);
  touches_.reserve(obstacles_.size());
}

bool CompliantObstacles::is_near(const Vector3d& p_WC, double speed, double dt) {
  if (shapes_.empty()) return false;
  const double radius = reach_ + laws::ahead(speed, dt);
  if (clear_.is_free(p_WC, radius)) return false;
  near_.clear();
  for (const Obstacle& obstacle : obstacles_) {
    if (least_distance_to(obstacle, p_WC) <= radius) near_.push_back(&obstacle);
  }
  return true;
}

bool CompliantObstacles::is_ahead(const Kinematics& k, double dt) const {
  for (const Shape& shape : shapes_) {
    const LinkMotion motion = find_shape_motion(model_, k, shape.link, *shape.collision);
    const double turning = shape.turns() ? motion.w_W.norm() : k.w_WF_F.norm();
    const double speed = motion.velocity(motion.p_WS).norm() + turning * shape.reach;
    const double radius = shape.reach + laws::ahead(speed, dt);
    for (const Obstacle* obstacle : near_) {
      if (least_distance_to(*obstacle, motion.p_WS) <= radius) return true;
    }
  }
  return false;
}

void CompliantObstacles::find_touches(const Vector3d& p_W, double radius) {
  touches_.clear();
  for (const Obstacle* obstacle : near_shape_) {
    const ObstacleDepth found = find_depth(*obstacle, p_W, radius);
    if (found.depth > 0) touches_.push_back({obstacle, found});
  }
  if (touches_.size() <= most_obstacles_at_once) return;
  std::partial_sort(touches_.begin(), touches_.begin() + most_obstacles_at_once, touches_.end(),
                    [](const Touch& a, const Touch& b) { return a.found.depth > b.found.depth; });
  touches_.resize(most_obstacles_at_once);
}

void CompliantObstacles::refuse_deep(const Kinematics& k, double dt) {
  for (const Shape& shape : shapes_) {
    const LinkMotion motion = find_shape_motion(model_, k, shape.link, *shape.collision);
    near_shape_ = near_;
    for (const Vector3d& p_S : shape.points_S) {
      find_touches(motion.p_WS + motion.R_WL * (shape.R_LS * p_S), shape.radius);
      for (const Touch& touch : touches_) {
        const double hardest = joint_stiffness(shape.collision->surface, touch.obstacle->surface);
        const Spring spring = make_spring(shape.stable.pressing, hardest, dt);
        if (spring.stiffness * touch.found.depth <= largest_start_force * weight_) continue;
        std::ostringstream what;
        what << "the vehicle starts " << touch.found.depth << " m deep in '"
             << touch.obstacle->model
             << "', and the contact of the engine eigen would throw it off. Start outside, or use "
                "the engine ode or gazebo11.";
        throw Error(what.str());
      }
    }
  }
}

void CompliantObstacles::begin(double dt) {
  dt_ = dt;
  stage_ = 0;
  for (Shape& shape : shapes_) {
    shape.bristle.begin(
        make_spring(shape.stable.rubbing, std::numeric_limits<double>::infinity(), dt));
  }
}

void CompliantObstacles::add_forces(const Kinematics& kinematics, Loads& loads) {
  for (Shape& shape : shapes_) press(shape, kinematics, loads);
  ++stage_;
}

void CompliantObstacles::press(Shape& shape, const Kinematics& k, Loads& loads) {
  const LinkMotion motion = find_shape_motion(model_, k, shape.link, *shape.collision);
  // The points of a body of revolution do not turn with its rotor: the springs move only the frame.
  LinkMotion pressed = motion;
  if (shape.revolves) {
    pressed.R_WL = k.R_WF * shape.R_FL_at_zero;
    pressed.w_W = k.R_WF * k.w_WF_F;
  }
  near_shape_.clear();
  for (const Obstacle* obstacle : near_) {
    if (least_distance_to(*obstacle, motion.p_WS) <= shape.reach) near_shape_.push_back(obstacle);
  }
  points_.clear();
  PressedPatch patch;
  Vector3d f_W = Vector3d::Zero(), tau_W = Vector3d::Zero(), center_W = Vector3d::Zero();
  Vector3d axis_W = shape.axis_W, sum_W = Vector3d::Zero();
  const Matrix3d R_WS = pressed.R_WL * shape.R_LS;
  for (const Vector3d& p_S : shape.points_S) {
    if (near_shape_.empty()) break;
    const Vector3d p_W = pressed.p_WS + R_WS * p_S;
    find_touches(p_W, shape.radius);
    for (const Touch& touch : touches_) {
      const Surface& surface = touch.obstacle->surface;
      const Vector3d& normal_W = touch.found.normal_W;
      const Vector3d q_W = p_W - shape.radius * normal_W;
      const Spring spring = make_spring(shape.stable.pressing,
                                        joint_stiffness(shape.collision->surface, surface), dt_);
      const double force = laws::pressure(spring.stiffness, spring.relaxation, touch.found.depth,
                                          -pressed.velocity(q_W).dot(normal_W));
      if (!(force > 0)) continue;
      const double mu1 = joint_mu1(shape.collision->surface, surface);
      const double mu2 = joint_mu2(shape.collision->surface, surface);
      patch.pressing += force;
      patch.friction += force * Vector3d(mu1, mu2, (mu1 + mu2) / 2);
      center_W += force * q_W;
      f_W += force * normal_W;
      if (axis_W.isZero(0)) axis_W = align(normal_W, Vector3d::UnitZ());
      sum_W += force * align(normal_W, axis_W);
      tau_W += (q_W - motion.p_W).cross(force * normal_W);
      points_.push_back({q_W, force});
    }
  }
  shape.next_axis_W.setZero();
  if (!(patch.pressing > 0)) return shape.bristle.release(stage_, dt_);
  add_pressing(k, shape, f_W, tau_W, loads);

  center_W /= patch.pressing;
  const double part = sum_W.norm() / patch.pressing;
  if (part > smallest_mean_normal) axis_W = sum_W / sum_W.norm();
  shape.next_axis_W = axis_W;
  const Quaterniond q_NW = shortest_rotation(axis_W, Vector3d::UnitZ());
  for (const Point& point : points_) {
    patch.square += point.force * (q_NW * (point.p_W - center_W)).head<2>().squaredNorm();
  }
  patch.reach = shape.reach;
  patch.direction = q_NW * (motion.R_WL * shape.R_LS * shape.collision->surface.fdir1);
  const PatchResistance resistance =
      shape.bristle.resist(patch, q_NW * motion.velocity(center_W), q_NW * motion.w_W, stage_, dt_);
  const Vector3d along_W = q_NW.conjugate() * resistance.along;
  add_link_load(k, shape.link, along_W,
                (center_W - motion.p_W).cross(along_W) + q_NW.conjugate() * resistance.turning,
                loads);
}

Vector3d CompliantObstacles::align(const Vector3d& normal_W, const Vector3d& axis_W) {
  return normal_W.dot(axis_W) < turned_round ? (-normal_W).eval() : normal_W;
}

/// Add the forces of the springs.
void CompliantObstacles::add_pressing(const Kinematics& k, const Shape& shape, const Vector3d& f_W,
                                      const Vector3d& tau_W, Loads& loads) {
  add_link_load(k, shape.link, f_W, tau_W, loads);
  if (!shape.revolves) return;
  const Vector3d axis_W = k.R_WF * k.rotors[shape.link - 1].axis_F;
  loads.add_joint_torque(shape.link - 1, -axis_W.dot(tau_W));
}

void CompliantObstacles::end() {
  for (Shape& shape : shapes_) {
    shape.bristle.end(dt_);
    shape.axis_W = shape.next_axis_W;
  }
}

void CompliantObstacles::clear() {
  for (Shape& shape : shapes_) {
    shape.bristle.clear();
    shape.axis_W.setZero();
  }
}

double* CompliantObstacles::save(double* to) const {
  for (const Shape& shape : shapes_) {
    to = shape.bristle.save(to);
    to = std::copy_n(shape.axis_W.data(), 3, to);
  }
  return to;
}

const double* CompliantObstacles::restore(const double* from) {
  for (Shape& shape : shapes_) {
    from = shape.bristle.restore(from);
    std::copy_n(from, 3, shape.axis_W.data());
    from += 3;
  }
  return from;
}

}  // namespace quadcore
