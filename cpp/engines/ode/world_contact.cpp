#include "world_contact.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "contact_surface.hpp"
#include "ode_math.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore {
namespace {

/// Number of points for which Gazebo 11 asks the collider of a pair.
constexpr int most_points = 250;
/// The vehicle and the ground, which is the first of the models.
constexpr ModelPair ground_pair = {0, false};

dGeomID create_shape(const Collision& collision) {
  const Vector3d& size = collision.size;
  switch (collision.kind) {
    case ShapeKind::box:
      return dCreateBox(nullptr, size.x(), size.y(), size.z());
    case ShapeKind::cylinder:
      return dCreateCylinder(nullptr, size.x(), size.y());
    case ShapeKind::sphere:
      return dCreateSphere(nullptr, size.x());
    case ShapeKind::mesh:
      break;
  }
  throw InputError(collision.where +
                   ": contact of a collision mesh with the ground is not modelled. Use a box, "
                   "cylinder or sphere, or a world without ground.");
}

/// Return the geom of an obstacle at its place.
dGeomID create_solid(const Obstacle& obstacle) {
  const Vector3d& size = obstacle.size;
  const Vector3d& p = obstacle.position_W;
  dGeomID geom = nullptr;
  switch (obstacle.kind) {
    case ObstacleKind::box:
      geom = dCreateBox(nullptr, size.x(), size.y(), size.z());
      break;
    case ObstacleKind::cylinder:
      geom = dCreateCylinder(nullptr, size.x(), size.y());
      break;
    case ObstacleKind::sphere:
      geom = dCreateSphere(nullptr, size.x());
      break;
    case ObstacleKind::plane:
      return dCreatePlane(nullptr, size.x(), size.y(), size.z(), p.z());
  }
  const Quaterniond& q = obstacle.orientation_W;
  const dQuaternion ode_q = {q.w(), q.x(), q.y(), q.z()};
  dGeomSetPosition(geom, p.x(), p.y(), p.z());
  dGeomSetQuaternion(geom, ode_q);
  return geom;
}

Obstacle create_ground(const Surface& surface) {
  Obstacle ground;
  ground.model = "ground_plane";
  ground.kind = ObstacleKind::plane;
  ground.size = Vector3d::UnitZ();
  ground.surface = surface;
  return ground;
}

/// Return an upper bound of the distance of a shape's points from its centre.
double radius(const Collision& collision) {
  const Vector3d& size = collision.size;
  switch (collision.kind) {
    case ShapeKind::box:
      return size.norm() / 2;
    case ShapeKind::cylinder:
      return size.x() + size.y() / 2;
    default:
      return size.x();
  }
}

/// Return an upper bound of the distance of a model's shapes from the frame's centre of mass [m].
double reach_of_shapes(const Model& model) {
  std::vector<double> arms(model.links.size());  // of the origins from the frame's
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    arms[i + 1] = arms[joint.parent] + joint.pose.xyz.norm();
  }
  double reach = 0;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    for (const Collision& collision : model.links[i].collisions) {
      reach = std::max(reach, arms[i] + collision.pose.xyz.norm() + radius(collision));
    }
  }
  return reach + model.links[0].inertial.pose.xyz.norm();
}

Bounds bounds_of(dGeomID geom) {
  Bounds box;
  dGeomGetAABB(geom, box.data());
  return box;
}

/// Put the deepest of the points from the last kept one on in its place, as Gazebo does.
int keep_points(std::vector<dContactGeom>& points, int found, int most) {
  if (found <= most) return found;
  if (most == 0) return 0;
  const auto last = points.begin() + most - 1;
  *last = *std::max_element(
      last, points.begin() + found,
      [](const dContactGeom& one, const dContactGeom& other) { return one.depth < other.depth; });
  return most;
}

}  // namespace

WorldContact::WorldContact(const Model& model, const std::vector<dBodyID>& bodies,
                           const World& world)
    : bodies_(bodies),
      gravity_W_(world.gravity_W),
      max_correction_(world.contact_max_correcting_vel),
      max_contacts_(world.max_contacts),
      has_ground_(world.ground_plane),
      reach_(reach_of_shapes(model)),
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
  for (std::vector<Solid>& solids : models_) {
    std::reverse(solids.begin(), solids.end());
    boxes.push_back(solids.front().box);
    for (const Solid& solid : solids) extend(boxes.back(), solid.box);
  }
  order_ = std::make_unique<PairOrder>(std::move(boxes));
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    for (const Collision& collision : model.links[i].collisions) {
      add_shape(collision, model, i, bodies);
    }
  }
  contacts_.reserve(most_on_ground());
}

std::size_t WorldContact::most_on_ground() const {
  std::size_t most = 0;
  for (const Shape& shape : shapes_) {
    most += static_cast<std::size_t>(
        std::min({shape.surface.max_contacts, max_contacts_, most_points}));
  }
  return most;
}

void WorldContact::add_obstacle(const Obstacle& obstacle) {
  Geom geom(create_solid(obstacle));
  const Bounds box = bounds_of(geom.get());
  models_.back().push_back(
      {std::move(geom), obstacle.surface, obstacle.slip1, obstacle.slip2, box});
}

void WorldContact::add_shape(const Collision& collision, const Model& model, std::size_t link,
                             const std::vector<dBodyID>& bodies) {
  const dGeomID geom = create_shape(collision);
  Surface surface = collision.surface;
  // Gazebo's ODE stores these two per body, so the values of the last shape count.
  surface.max_vel = model.links[link].collisions.back().surface.max_vel;
  surface.min_depth = model.links[link].collisions.back().surface.min_depth;
  shapes_.push_back({Geom(geom), link, surface});
  const Vector3d p_cm = collision.pose.xyz - model.links[link].inertial.pose.xyz;
  const Quaterniond q = collision.pose.rotation();
  const dQuaternion ode_q = {q.w(), q.x(), q.y(), q.z()};
  reaches_.push_back({link, p_cm.norm() + radius(collision)});
  dGeomSetBody(geom, bodies[link]);
  dGeomSetOffsetPosition(geom, p_cm.x(), p_cm.y(), p_cm.z());
  dGeomSetOffsetQuaternion(geom, ode_q);
}

const std::vector<Contact>& WorldContact::find() {
  contacts_.clear();
  if (shapes_.empty()) return contacts_;
  const Bounds box = find_bounds();
  if (!is_obstacle_ahead(0)) {
    if (has_ground_) collide(ground_pair);
    return contacts_;
  }
  for (const ModelPair& pair : order_->find(box)) collide(pair);
  return contacts_;
}

/// Update the bounding boxes of the shapes and return that of all.
Bounds WorldContact::find_bounds() {
  for (Shape& shape : shapes_) shape.box = bounds_of(shape.geom.get());
  Bounds all = shapes_.front().box;
  for (const Shape& shape : shapes_) extend(all, shape.box);
  return all;
}

/// Collide all shapes of a vehicle and a model. Gazebo's outer loop is over the one with fewer
/// shapes, otherwise over the second.
void WorldContact::collide(const ModelPair& pair) {
  const std::vector<Solid>& solids = models_[pair.obstacle];
  const bool has_fewer =
      pair.obstacle_first ? solids.size() < shapes_.size() : solids.size() <= shapes_.size();
  if (has_fewer) {
    for (const Solid& solid : solids) {
      for (const Shape& shape : shapes_) touch(shape, solid, pair.obstacle_first);
    }
  } else {
    for (const Shape& shape : shapes_) {
      for (const Solid& solid : solids) touch(shape, solid, pair.obstacle_first);
    }
  }
}

void WorldContact::touch(const Shape& shape, const Solid& solid, bool solid_first) {
  if (!overlap(shape.box, solid.box)) return;
  const dGeomID first = solid_first ? solid.geom.get() : shape.geom.get();
  const dGeomID second = solid_first ? shape.geom.get() : solid.geom.get();
  const Surface &own = shape.surface, &other = solid.surface;
  const int found = dCollide(first, second, most_points, touching_.data(), sizeof(dContactGeom));
  const int kept = keep_points(touching_, found,
                               std::min({own.max_contacts, other.max_contacts, max_contacts_}));
  if (kept == 0) return;
  const SurfacePair surface = {joint_stiffness(own, other),
                               joint_damping(own, other),
                               joint_mu1(own, other),
                               joint_mu2(own, other),
                               std::min(own.max_vel, max_correction_),
                               kept * solid.slip1,
                               kept * solid.slip2};
  // Gazebo uses only the first shape's direction of friction.
  const Vector3d fdir1_W = rotation(dGeomGetRotation(first)) * (solid_first ? other : own).fdir1;
  for (int i = 0; i < kept; ++i) {
    const dContactGeom& point = touching_[static_cast<std::size_t>(i)];
    const Vector3d normal_W = solid_first ? (-vec(point.normal)).eval() : vec(point.normal).eval();
    contacts_.push_back({shape.body, vec(point.pos), normal_W, fdir1_W,
                         std::max(0.0, point.depth - own.min_depth), surface});
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
  if (clear_ball_.is_empty()) return true;
  const double fallen = gravity_W_.norm() * time * time / 2;
  return clear_ball_.is_free(p_WFcm, reach_ + fallen + time * v_WFcm_W.norm());
}

bool WorldContact::is_ground_ahead(double time) const {
  const Vector3d w_WF_W = vec(dBodyGetAngularVel(bodies_[0]));
  const double fallen = std::min(0.0, gravity_W_.z()) * time * time / 2;
  for (const Shape& shape : shapes_) {
    const dBodyID body = bodies_[shape.body];
    const Vector3d arm_W = vec(dGeomGetPosition(shape.geom.get())) - vec(dBodyGetPosition(body));
    const Bounds box = bounds_of(shape.geom.get());
    const double reach = Vector3d(box[1] - box[0], box[3] - box[2], box[5] - box[4]).norm() / 2;
    const double v_z = dBodyGetLinearVel(body)[2] + w_WF_W.cross(arm_W).z();
    if (box[4] + fallen + time * (v_z - w_WF_W.norm() * reach) < 0) return true;
  }
  return false;
}

}  // namespace quadcore
