#include "ground_contact.hpp"

#include <algorithm>

#include "ground_surface.hpp"
#include "ode_math.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore {
namespace {

// Measured in the running Gazebo 11.
constexpr int max_contacts_per_pair = 10;

SurfacePair on_ground(const Surface& surface, double max_correction) {
  return {ground::stiffness_with(surface), ground::damping_with(surface), ground::mu1_with(surface),
          ground::mu2_with(surface), std::min(surface.max_vel, max_correction)};
}

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

}  // namespace

GroundContact::GroundContact(const Model& model, const std::vector<dBodyID>& bodies,
                             double max_correction)
    : bodies_(bodies), plane_(dCreatePlane(nullptr, 0, 0, 1, 0)) {
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    for (const Collision& collision : model.links[i].collisions) {
      const dGeomID geom = create_shape(collision);
      Surface surface = collision.surface;
      // Gazebo's ODE stores these two per body, so the values of the last shape count.
      surface.max_vel = model.links[i].collisions.back().surface.max_vel;
      surface.min_depth = model.links[i].collisions.back().surface.min_depth;
      shapes_.push_back({Geom(geom), i, on_ground(surface, max_correction), surface.fdir1,
                         surface.min_depth, std::min(surface.max_contacts, max_contacts_per_pair)});
      const Vector3d p_cm = collision.pose.xyz - model.links[i].inertial.pose.xyz;
      const Quaterniond q = collision.pose.rotation();
      const dQuaternion ode_q = {q.w(), q.x(), q.y(), q.z()};
      reaches_.push_back({i, p_cm.norm() + radius(collision)});
      dGeomSetBody(geom, bodies[i]);
      dGeomSetOffsetPosition(geom, p_cm.x(), p_cm.y(), p_cm.z());
      dGeomSetOffsetQuaternion(geom, ode_q);
    }
  }
  contacts_.reserve(shapes_.size() * max_contacts_per_pair);
}

const std::vector<Contact>& GroundContact::find() {
  contacts_.clear();
  dContactGeom touching[max_contacts_per_pair];
  for (const Shape& shape : shapes_) {
    const int found = dCollide(shape.geom.get(), plane_.get(), shape.max_contacts, touching,
                               sizeof(dContactGeom));
    if (found == 0) continue;
    const Vector3d fdir1_W = rotation(dGeomGetRotation(shape.geom.get())) * shape.fdir1;
    for (int i = 0; i < found; ++i) {
      contacts_.push_back({shape.body, vec(touching[i].pos), vec(touching[i].normal), fdir1_W,
                           std::max(0.0, touching[i].depth - shape.min_depth), &shape.surface});
    }
  }
  return contacts_;
}

bool GroundContact::is_ahead(double time, double gravity_z) const {
  const Vector3d w_WF_W = vec(dBodyGetAngularVel(bodies_[0]));
  const double fallen = std::min(0.0, gravity_z) * time * time / 2;
  for (const Shape& shape : shapes_) {
    const dBodyID body = bodies_[shape.body];
    const Vector3d arm_W = vec(dGeomGetPosition(shape.geom.get())) - vec(dBodyGetPosition(body));
    dReal box[6];
    dGeomGetAABB(shape.geom.get(), box);
    const double reach = Vector3d(box[1] - box[0], box[3] - box[2], box[5] - box[4]).norm() / 2;
    const double v_z = dBodyGetLinearVel(body)[2] + w_WF_W.cross(arm_W).z();
    if (box[4] + fallen + time * (v_z - w_WF_W.norm() * reach) < 0) return true;
  }
  return false;
}

}  // namespace quadcore
