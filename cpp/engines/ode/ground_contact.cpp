#include "ground_contact.hpp"

#include "ode_math.hpp"
#include "quadcore/error.hpp"

namespace quadcore {
namespace {

constexpr int max_contacts_per_pair = 10;
// Measured in the running Gazebo 11: a model's kp 1e12 and kd 1 in series and sum with the
// ground's, its friction 1 (the smaller of a pair), no bounce, no slip.
constexpr double stiffness = 5e11;  // N/m
constexpr double damping = 2;       // N s/m
constexpr double friction = 1;

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
  throw InputError(
      collision.where +
      ": a collision mesh cannot touch the ground; write a box, cylinder or sphere, or "
      "fly in empty.world");
}

}  // namespace

GroundContact::GroundContact(const Model& model, const std::vector<dBodyID>& bodies)
    : plane_(dCreatePlane(nullptr, 0, 0, 1, 0)) {
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    for (const Collision& collision : model.links[i].collisions) {
      const dGeomID geom = create_shape(collision);
      shapes_.push_back({Geom(geom), i});
      const Vector3d p_cm = collision.pose.xyz - model.links[i].inertial.pose.xyz;
      const Quaterniond q = collision.pose.rotation();
      const dQuaternion ode_q = {q.w(), q.x(), q.y(), q.z()};
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
    const int found = dCollide(shape.geom.get(), plane_.get(), max_contacts_per_pair, touching,
                               sizeof(dContactGeom));
    for (int i = 0; i < found; ++i) {
      contacts_.push_back(
          {shape.body, vec(touching[i].pos), vec(touching[i].normal), touching[i].depth});
    }
  }
  return contacts_;
}

Surface GroundContact::surface(double dt) {
  return {dt * stiffness / (dt * stiffness + damping), 1 / (dt * stiffness + damping), friction};
}

}  // namespace quadcore
