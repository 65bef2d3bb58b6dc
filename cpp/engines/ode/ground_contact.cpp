#include "ground_contact.hpp"

#include "ode_math.hpp"
#include "quadcore/error.hpp"

namespace quadcore {
namespace {

constexpr int max_contacts_per_pair = 10;
// Measured in the running Gazebo 11: a model's kp 1e12 and kd 1 in series and sum with the ground's,
// its friction 1 (the smaller of a pair), no bounce, no slip.
constexpr double stiffness = 5e11;  // N/m
constexpr double damping = 2;       // N s/m
constexpr double friction = 1;

dSurfaceParameters surface(double dt) {
  dSurfaceParameters s{};
  s.mode = dContactBounce | dContactMu2 | dContactSoftERP | dContactSoftCFM | dContactApprox1 |
           dContactSlip1 | dContactSlip2;
  s.mu = friction;
  s.mu2 = friction;
  s.soft_erp = dt * stiffness / (dt * stiffness + damping);
  s.soft_cfm = 1 / (dt * stiffness + damping);
  return s;
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
                   ": a collision mesh cannot touch the ground; write a box, cylinder or sphere, or "
                   "fly in empty.world");
}

}  // namespace

GroundContact::GroundContact(const Model& model, const std::vector<dBodyID>& bodies)
    : plane_(dCreatePlane(nullptr, 0, 0, 1, 0)), contacts_(dJointGroupCreate(0)) {
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    for (const Collision& collision : model.links[i].collisions) {
      shapes_.emplace_back(create_shape(collision));
      const dGeomID geom = shapes_.back().get();
      const Vector3d p_cm = collision.pose.xyz - model.links[i].inertial.pose.xyz;
      const Quaterniond q = collision.pose.rotation();
      const dQuaternion ode_q = {q.w(), q.x(), q.y(), q.z()};
      dGeomSetBody(geom, bodies[i]);
      dGeomSetOffsetPosition(geom, p_cm.x(), p_cm.y(), p_cm.z());
      dGeomSetOffsetQuaternion(geom, ode_q);
    }
  }
}

int GroundContact::collide(dWorldID world, double dt) {
  dJointGroupEmpty(contacts_.get());
  int count = 0;
  dContactGeom touching[max_contacts_per_pair];
  for (const Geom& shape : shapes_) {
    const int found = dCollide(shape.get(), plane_.get(), max_contacts_per_pair, touching,
                               sizeof(dContactGeom));
    for (int i = 0; i < found; ++i) {
      dContact contact{};
      contact.surface = surface(dt);
      contact.geom = touching[i];
      const dJointID joint = dJointCreateContact(world, contacts_.get(), &contact);
      dJointAttach(joint, dGeomGetBody(shape.get()), nullptr);
    }
    count += found;
  }
  return count;
}

}  // namespace quadcore
