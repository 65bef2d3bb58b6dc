#include "world_contact.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "contact_points.hpp"
#include "contact_surface.hpp"
#include "ode_math.hpp"

namespace quadcore {
namespace {

/// Bounds of a model that touches nothing.
constexpr Bounds nowhere = {dInfinity, -dInfinity, dInfinity, -dInfinity, dInfinity, -dInfinity};

Obstacle create_ground(const Surface& surface) {
  Obstacle ground;
  ground.model = "ground_plane";
  ground.kind = ShapeKind::plane;
  ground.size = Vector3d::UnitZ();
  ground.surface = surface;
  return ground;
}

Bounds bounds_of(dGeomID geom) {
  Bounds box;
  dGeomGetAABB(geom, box.data());
  return box;
}

}  // namespace

double reach_of_shapes(const Model& model) {
  std::vector<double> arms(model.links.size());  // of the origins from the frame's
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    arms[i + 1] = arms[joint.parent] + joint.pose.xyz.norm();
  }
  double reach = 0;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    for (const Collision& collision : model.links[i].collisions) {
      reach = std::max(reach, arms[i] + collision.pose.xyz.norm() +
                                  outer_radius(collision.kind, collision.size));
    }
  }
  return reach + model.links[0].inertial.pose.xyz.norm();
}

WorldContact::WorldContact(const std::vector<const Model*>& vehicles,
                           const std::vector<dBodyID>& bodies, const World& world)
    : bodies_(bodies),
      gravity_W_(world.gravity_W),
      max_correction_(world.contact_max_correcting_vel),
      max_contacts_(world.max_contacts),
      has_ground_(world.ground_plane),
      reach_(reach_of_shapes(*vehicles.front())),
      clear_ball_(world.obstacles),
      touching_(most_points) {
  std::string last;
  std::vector<Obstacle> obstacles = world.obstacles;
  if (has_ground_) obstacles.insert(obstacles.begin(), create_ground(world.ground));
  for (const Obstacle& obstacle : obstacles) {
    if (models_.empty() || obstacle.model != last) models_.emplace_back();
    last = obstacle.model;
    add_obstacle(obstacle);
  }
  std::vector<Bounds> boxes;
  for (Shapes& shapes : models_) {
    std::reverse(shapes.begin(), shapes.end());
    boxes.push_back(shapes.front().box);
    for (const Shape& shape : shapes) extend(boxes.back(), shape.box);
  }
  order_ = std::make_unique<PairOrder>(boxes);
  still_ = models_.size();
  std::size_t first_free = 0;
  for (const Model* const model : vehicles) first_free += model->links.size();
  add_free_bodies(world, first_free);
  first_vehicle_ = models_.size();
  std::size_t body = 0;
  for (const Model* const model : vehicles) {
    models_.emplace_back();
    for (const Link& link : model->links) {
      for (const Collision& collision : link.collisions) add_shape(collision, link, body);
      ++body;
    }
  }
  contacts_.reserve(most_on_ground());
  moving_.reserve(models_.size() - still_);
}

std::size_t WorldContact::most_on_ground() const {
  std::size_t most = 0;
  for (const Shape& shape : vehicle()) {
    most += static_cast<std::size_t>(
        std::min({shape.surface.max_contacts, max_contacts_, most_points}));
  }
  return most;
}

void WorldContact::add_obstacle(const Obstacle& obstacle) {
  Geom geom = create_solid(obstacle);
  const Bounds box = bounds_of(geom.get());
  models_.back().push_back({std::move(geom), -1, obstacle.surface, obstacle.slip1, obstacle.slip2,
                            obstacle.restitution, obstacle.restitution_speed, obstacle.mesh, box});
}

/// Add the free bodies, which are in the list of bodies from an index on.
void WorldContact::add_free_bodies(const World& world, std::size_t first) {
  std::string last;
  for (std::size_t i = 0; i < world.free_bodies.size(); ++i) {
    const FreeBody& free = world.free_bodies[i];
    const dBodyID body = bodies_[first + i];
    balls_.push_back({body, 0});
    if (free.shapes.empty()) continue;
    if (models_.size() == still_ || free.model != last || free.collides_own) {
      models_.emplace_back();
    }
    last = free.model;
    for (const Obstacle& given : free.shapes) {
      Surface surface = given.surface;
      surface.max_vel = free.shapes.back().surface.max_vel;
      surface.min_depth = free.shapes.back().surface.min_depth;
      Geom geom = create_solid(given);
      const Vector3d p = given.position_W;
      const Quaterniond& q = given.orientation_W;
      const dQuaternion ode_q = {q.w(), q.x(), q.y(), q.z()};
      dGeomSetBody(geom.get(), body);
      dGeomSetOffsetWorldPosition(geom.get(), p.x(), p.y(), p.z());
      dGeomSetOffsetWorldQuaternion(geom.get(), ode_q);
      double& radius = balls_.back().radius;
      radius = std::max(radius, (p - vec(dBodyGetPosition(body))).norm() + outer_radius(given));
      models_.back().push_back({std::move(geom), static_cast<int>(first + i), surface, given.slip1,
                                given.slip2, given.restitution, given.restitution_speed,
                                given.mesh});
    }
  }
  for (const FreeJoint& joint : world.free_joints) {
    if (joint.parent == FreeJoint::world) continue;
    const auto ends = std::minmax(joint.child, joint.parent);
    joined_.emplace(static_cast<int>(first + ends.first), static_cast<int>(first + ends.second));
  }
}

void WorldContact::add_shape(const Collision& collision, const Link& link, std::size_t body) {
  Geom geom = create_shape(collision);
  Surface surface = collision.surface;
  // Gazebo's ODE stores these two per body, so the values of the last shape count.
  surface.max_vel = link.collisions.back().surface.max_vel;
  surface.min_depth = link.collisions.back().surface.min_depth;
  const Vector3d p_cm = collision.pose.xyz - link.inertial.pose.xyz;
  const Quaterniond q = collision.pose.rotation();
  const dQuaternion ode_q = {q.w(), q.x(), q.y(), q.z()};
  reaches_.push_back({body, p_cm.norm() + outer_radius(collision.kind, collision.size)});
  dGeomSetBody(geom.get(), bodies_[body]);
  dGeomSetOffsetPosition(geom.get(), p_cm.x(), p_cm.y(), p_cm.z());
  dGeomSetOffsetQuaternion(geom.get(), ode_q);
  models_.back().push_back({std::move(geom), static_cast<int>(body), surface});
}

const std::vector<Contact>& WorldContact::find(const std::vector<double>& unmoved) {
  contacts_.clear();
  find_free_bounds(unmoved);
  if (vehicle().empty()) return find_pairs();
  moving_.push_back(find_vehicle(vehicle()));
  if (balls_.empty() && !is_obstacle_ahead(0)) {
    if (has_ground_) collide({models_.size() - 1, 0});
    return contacts_;
  }
  return find_pairs();
}

const std::vector<Contact>& WorldContact::find_free(const std::vector<double>& unmoved) {
  contacts_.clear();
  find_free_bounds(unmoved);
  return find_pairs();
}

const std::vector<Contact>& WorldContact::find_among(const std::vector<char>& vehicles,
                                                     const std::vector<double>& unmoved) {
  contacts_.clear();
  find_free_bounds(unmoved);
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    Shapes& shapes = models_[first_vehicle_ + i];
    const bool is_there = vehicles[i] && !shapes.empty();
    moving_.push_back(is_there ? find_vehicle(shapes) : MovingModel{nowhere});
  }
  return find_pairs();
}

void WorldContact::find_free_bounds(const std::vector<double>& unmoved) {
  moving_.clear();
  for (std::size_t i = still_; i < first_vehicle_; ++i) {
    MovingModel free = {find_bounds(models_[i]), dInfinity};
    for (const Shape& shape : models_[i]) {
      free.unmoved = std::min(free.unmoved, unmoved[static_cast<std::size_t>(shape.body)]);
    }
    moving_.push_back(free);
  }
}

/// A vehicle counts as moved once a free body has moved, and in a world without free bodies.
MovingModel WorldContact::find_vehicle(Shapes& shapes) const {
  const auto is_new = [](const MovingModel& free) { return std::isinf(free.unmoved); };
  const auto end = moving_.begin() + static_cast<std::ptrdiff_t>(first_vehicle_ - still_);
  const bool is_first = end != moving_.begin() && std::all_of(moving_.begin(), end, is_new);
  return {find_bounds(shapes), is_first ? dInfinity : 0};
}

const std::vector<Contact>& WorldContact::find_pairs() {
  if (!moving_.empty()) {
    for (const ModelPair& pair : order_->find(moving_)) collide(pair);
    for (const auto& [one, other] : of_meshes_) touch(*one, *other);
    of_meshes_.clear();
  }
  return contacts_;
}

/// Update the bounding boxes of the shapes of a model, and return that of all.
Bounds WorldContact::find_bounds(Shapes& shapes) const {
  for (Shape& shape : shapes) shape.box = bounds_of(shape.geom.get());
  Bounds all = shapes.front().box;
  for (const Shape& shape : shapes) extend(all, shape.box);
  return all;
}

/// Collide all shapes of two models. Gazebo's outer loop is over the one with fewer shapes,
/// otherwise over the second.
void WorldContact::collide(const ModelPair& pair) {
  const Shapes &first = models_[pair.first], &second = models_[pair.second];
  if (second.size() <= first.size()) {
    for (const Shape& other : second) {
      for (const Shape& one : first) meet(one, other);
    }
  } else {
    for (const Shape& one : first) {
      for (const Shape& other : second) meet(one, other);
    }
  }
}

bool WorldContact::are_joined(const Shape& one, const Shape& other) const {
  return !joined_.empty() && joined_.count(std::minmax(one.body, other.body));
}

/// Gazebo collides meshes after all other pairs.
void WorldContact::meet(const Shape& one, const Shape& other) {
  if (!overlap(one.box, other.box) || are_joined(one, other)) return;
  if (one.mesh || other.mesh) {
    of_meshes_.emplace_back(&one, &other);
  } else {
    touch(one, other);
  }
}

/// Add the contacts of two shapes, the first of which has the say in the direction of friction.
void WorldContact::touch(const Shape& one, const Shape& other) {
  const int found = find_points(one.geom.get(), other.geom.get(), touching_);
  const int kept =
      keep_points(touching_, found,
                  std::min({one.surface.max_contacts, other.surface.max_contacts, max_contacts_}));
  if (kept == 0) return;
  // Of a static shape these do not count.
  double max_vel = max_correction_, min_depth = 0;
  bool is_first = true;
  for (const Shape* shape : {&one, &other}) {
    if (shape->body < 0) continue;
    max_vel = std::min(max_vel, shape->surface.max_vel);
    min_depth = is_first ? shape->surface.min_depth : std::min(min_depth, shape->surface.min_depth);
    is_first = false;
  }
  const SurfacePair surface = {joint_stiffness(one.surface, other.surface),
                               joint_damping(one.surface, other.surface),
                               joint_mu1(one.surface, other.surface),
                               joint_mu2(one.surface, other.surface),
                               max_vel,
                               kept * (one.slip1 + other.slip1),
                               kept * (one.slip2 + other.slip2),
                               std::min(one.restitution, other.restitution),
                               std::min(one.restitution_speed, other.restitution_speed)};
  // Gazebo uses only the first shape's direction of friction.
  const Vector3d fdir1_W = rotation(dGeomGetRotation(one.geom.get())) * one.surface.fdir1;
  const bool is_on_second = one.body < 0;
  for (int i = 0; i < kept; ++i) {
    const dContactGeom& point = touching_[static_cast<std::size_t>(i)];
    const Vector3d normal_W = is_on_second ? (-vec(point.normal)).eval() : vec(point.normal).eval();
    contacts_.push_back({static_cast<std::size_t>(is_on_second ? other.body : one.body),
                         vec(point.pos), normal_W, fdir1_W, std::max(0.0, point.depth - min_depth),
                         surface, is_on_second ? -1 : other.body});
  }
}

bool WorldContact::is_ahead(double time) {
  if (has_ground_ && is_ground_ahead(time)) return true;
  return is_obstacle_ahead(time);
}

bool WorldContact::is_obstacle_ahead(double time) {
  return !is_clear(vec(dBodyGetPosition(bodies_[0])), vec(dBodyGetLinearVel(bodies_[0])), time);
}

bool WorldContact::is_clear(const Vector3d& p_WFcm, const Vector3d& v_WFcm_W, double time) {
  if (!is_clear_of_free(p_WFcm, v_WFcm_W, reach_, time)) return false;
  if (clear_ball_.is_empty()) return true;
  const double fallen = gravity_W_.norm() * time * time / 2;
  return clear_ball_.is_free(p_WFcm, reach_ + fallen + time * v_WFcm_W.norm());
}

bool WorldContact::is_clear_of_free(const Vector3d& p_WFcm, const Vector3d& v_WFcm_W, double reach,
                                    double time) const {
  const double fallen = gravity_W_.norm() * time * time / 2;
  for (const Ball& ball : balls_) {
    const Vector3d away_W = vec(dBodyGetPosition(ball.body)) - p_WFcm;
    const double closer = time * (v_WFcm_W - vec(dBodyGetLinearVel(ball.body))).norm();
    if (!(away_W.norm() > reach + ball.radius + 2 * fallen + closer)) return false;
  }
  return true;
}

bool WorldContact::is_ground_ahead(double time) const {
  const Vector3d w_WF_W = vec(dBodyGetAngularVel(bodies_[0]));
  const double fallen = std::min(0.0, gravity_W_.z()) * time * time / 2;
  for (const Shape& shape : vehicle()) {
    const dBodyID body = bodies_[static_cast<std::size_t>(shape.body)];
    const Vector3d arm_W = vec(dGeomGetPosition(shape.geom.get())) - vec(dBodyGetPosition(body));
    const Bounds box = bounds_of(shape.geom.get());
    const double reach = Vector3d(box[1] - box[0], box[3] - box[2], box[5] - box[4]).norm() / 2;
    const double v_z = dBodyGetLinearVel(body)[2] + w_WF_W.cross(arm_W).z();
    if (box[4] + fallen + time * (v_z - w_WF_W.norm() * reach) < 0) return true;
  }
  return false;
}

}  // namespace quadcore
