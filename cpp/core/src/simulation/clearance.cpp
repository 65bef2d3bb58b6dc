#include "quadcore/clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "shortest_rotation.hpp"

namespace quadcore {
namespace {

using Convex = Clearance::Convex;

constexpr int most_projections = 1000;
constexpr double least_progress = 1e-9;  // m

Convex make_convex(ShapeKind kind, const Vector3d& size, const Vector3d& position,
                   const Quaterniond& rotation) {
  return {kind, size, position, rotation, outer_radius(kind, size)};
}

/// Return the point of a shape that is nearest to a point, both in the same axes as the shape.
Vector3d project(const Convex& shape, const Vector3d& point) {
  Vector3d p = shape.rotation.conjugate() * (point - shape.position);
  switch (shape.kind) {
    case ShapeKind::box:
      p = p.cwiseMax(-shape.size / 2).cwiseMin(shape.size / 2);
      break;
    case ShapeKind::cylinder: {
      const double around = p.head<2>().norm();
      if (around > shape.size.x()) p.head<2>() *= shape.size.x() / around;
      p.z() = std::clamp(p.z(), -shape.size.y() / 2, shape.size.y() / 2);
      break;
    }
    default:
      if (p.norm() > shape.size.x()) p *= shape.size.x() / p.norm();
  }
  return shape.position + shape.rotation * p;
}

/// Return the distance of a convex shape from another convex set by alternating projections from a
/// point, which converge to the nearest points of two convex sets (Cheney, Goldstein 1959). Between
/// faces that are nearly parallel they converge slowly; the distance is then an upper bound.
/// \param project_b  returns the point of the other set that is nearest to a point
template <class Projection>
double distance_from(Vector3d p, const Convex& a, const Projection& project_b) {
  double distance = INFINITY;
  for (int i = 0; i < most_projections; ++i) {
    const Vector3d q = project_b(p);
    p = project(a, q);
    const double shorter = (p - q).norm();
    if (distance - shorter < least_progress) return shorter;
    distance = shorter;
  }
  return distance;
}

double distance_from(const Vector3d& p, const Convex& a, const Convex& b) {
  return distance_from(p, a, [&](const Vector3d& from) { return project(b, from); });
}

/// Return points of a shape's surface that lie furthest out: the corners of a box, and eight points
/// of each rim of a cylinder.
std::vector<Vector3d> outer_points(const Convex& shape) {
  std::vector<Vector3d> points;
  const auto add = [&](const Vector3d& p) {
    points.push_back(shape.position + shape.rotation * p);
  };
  if (shape.kind == ShapeKind::box) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d signs(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      add(signs.cwiseProduct(shape.size) / 2);
    }
  } else if (shape.kind == ShapeKind::cylinder) {
    const double r = shape.size.x(), h = shape.size.y() / 2, s = r * std::sqrt(0.5);
    for (const double z : {-h, h}) {
      for (const double x : {-r, r}) add({x, 0, z});
      for (const double y : {-r, r}) add({0, y, z});
      for (const double x : {-s, s}) {
        for (const double y : {-s, s}) add({x, y, z});
      }
    }
  }
  return points;
}

Convex move_to(Convex shape, const Vector3d& p_WF, const Quaterniond& R_WF) {
  shape.position = p_WF + R_WF * shape.position;
  shape.rotation = R_WF * shape.rotation;
  return shape;
}

/// Return the distance of two convex shapes: the shortest from their centres and outer points, so
/// that an edge or a corner that touches a nearly parallel face is found.
double distance_between(const Convex& a, const Convex& b) {
  double distance = distance_from(a.position, a, b);
  for (const Vector3d& p : outer_points(a)) distance = std::min(distance, distance_from(p, a, b));
  for (const Vector3d& p : outer_points(b)) distance = std::min(distance, distance_from(p, b, a));
  return distance;
}

/// Return the distance of a convex shape from a mesh, if it is shorter than a known one.
double distance_from_mesh(const Convex& shape, const Obstacle& obstacle, double known) {
  if (least_distance_to(obstacle, shape.position) - shape.radius >= known) return known;
  const std::vector<Vector3d> points = outer_points(shape);
  for (const TriangleMesh::Triangle& triangle : obstacle.mesh->triangles) {
    std::array<Vector3d, 3> corners_W = corners_of(*obstacle.mesh, triangle);
    for (Vector3d& p : corners_W) p = obstacle.position_W + obstacle.orientation_W * p;
    const auto project_onto = [&](const Vector3d& p) {
      return project_onto_triangle(corners_W, p);
    };
    const Vector3d& center = shape.position;
    if ((project_onto(center) - center).norm() - shape.radius >= known) continue;
    known = std::min(known, distance_from(center, shape, project_onto));
    for (const Vector3d& p : points) known = std::min(known, distance_from(p, shape, project_onto));
  }
  return known;
}

/// Return the extent of a shape along a direction, from its centre [m].
double extent(const Convex& shape, const Vector3d& direction) {
  const Vector3d along = shape.rotation.conjugate() * direction;
  if (shape.kind == ShapeKind::box) return along.cwiseAbs().dot(shape.size) / 2;
  if (shape.kind == ShapeKind::sphere) return shape.size.x();
  return shape.size.x() * along.head<2>().norm() + shape.size.y() / 2 * std::abs(along.z());
}

/// Return the cylinder around a joint's axis that contains what a shape of the child link sweeps.
Convex sweep(const Convex& shape, const Vector3d& axis) {
  const double along = shape.position.dot(axis);
  const Vector3d aside = shape.position - along * axis;
  double radius = 0;
  const Vector3d own_axis = shape.rotation * Vector3d::UnitZ();
  const double cosine = std::abs(own_axis.dot(axis));
  if (shape.kind == ShapeKind::box) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d signs(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      const Vector3d p = shape.position + shape.rotation * (signs.cwiseProduct(shape.size) / 2);
      radius = std::max(radius, (p - p.dot(axis) * axis).norm());
    }
  } else {
    const double half = shape.kind == ShapeKind::cylinder ? shape.size.y() / 2 : 0;
    radius = aside.norm() + shape.size.x() + half * std::sqrt(std::max(0.0, 1 - cosine * cosine));
  }
  return make_convex(ShapeKind::cylinder, {radius, 2 * extent(shape, axis), 0}, along * axis,
                     shortest_rotation(Vector3d::UnitZ(), axis));
}

}  // namespace

Clearance::Clearance(const Model& model, const World& world) : given_(world.obstacles) {
  const std::vector<Eigen::Isometry3d> X_FL = link_poses(model);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const Quaterniond R_FL(X_FL[i].linear());
    for (const Collision& shape : model.links[i].collisions) {
      if (shape.kind == ShapeKind::mesh) continue;
      Convex convex = make_convex(shape.kind, shape.size, shape.pose.xyz, shape.pose.rotation());
      if (i > 0) convex = sweep(convex, model.joints[i - 1].axis);
      convex.position = X_FL[i] * convex.position;
      convex.rotation = R_FL * convex.rotation;
      shapes_F_.push_back(convex);
    }
  }
  for (const Obstacle& o : given_) {
    obstacles_W_.push_back(make_convex(o.kind, o.size, o.position_W, o.orientation_W));
  }
}

Clearance::Nearest Clearance::find(const Vector3d& p_WF, const Quaterniond& R_WF) const {
  Nearest nearest;
  for (const Convex& shape_F : shapes_F_) {
    const Convex shape = move_to(shape_F, p_WF, R_WF);
    for (std::size_t i = 0; i < given_.size(); ++i) {
      double distance = 0;
      if (given_[i].kind == ShapeKind::plane) {
        const Vector3d normal = given_[i].size.normalized();
        distance = std::max(0.0, distance_to(given_[i], shape.position) - extent(shape, normal));
      } else if (given_[i].kind == ShapeKind::mesh) {
        distance = distance_from_mesh(shape, given_[i], nearest.distance);
      } else {
        const Convex& obstacle = obstacles_W_[i];
        const double bound =
            (obstacle.position - shape.position).norm() - obstacle.radius - shape.radius;
        if (bound >= nearest.distance) continue;
        distance = distance_between(shape, obstacle);
      }
      if (distance < nearest.distance) nearest = {distance, i};
    }
  }
  return nearest;
}

double Clearance::distance_between_vehicles(const Clearance& other, const FramePose& own,
                                            const FramePose& others, double known) const {
  for (const Convex& shape_F : shapes_F_) {
    const Convex shape = move_to(shape_F, own.position_W, own.orientation_W);
    for (const Convex& other_F : other.shapes_F_) {
      const Convex against = move_to(other_F, others.position_W, others.orientation_W);
      const double bound =
          (against.position - shape.position).norm() - against.radius - shape.radius;
      if (bound < known) known = std::min(known, distance_between(shape, against));
    }
  }
  return known;
}

}  // namespace quadcore
