#pragma once

#include <ode/ode.h>

#include <memory>
#include <vector>

#include "quadcore/model.hpp"

namespace quadcore {

/// Contacts of a vehicle's collision shapes with the ground plane z = 0, with the surface that
/// Gazebo 11 gives a model on its ground plane. Links of one model do not collide with each other.
class GroundContact {
 public:
  /// \param bodies  one per link of the model, each at its link's centre of mass.
  /// Throws InputError on a shape that cannot collide (a mesh).
  GroundContact(const Model& model, const std::vector<dBodyID>& bodies);

  /// Replaces the contact joints of the last step by those of the present poses.
  /// \param dt  the step they are for [s]; softness depends on it
  /// \return how many there are
  int collide(dWorldID world, double dt);

 private:
  struct DestroyGeom {
    void operator()(dxGeom* geom) const { dGeomDestroy(geom); }
  };
  struct DestroyGroup {
    void operator()(dxJointGroup* group) const { dJointGroupDestroy(group); }
  };
  using Geom = std::unique_ptr<dxGeom, DestroyGeom>;

  Geom plane_;
  std::vector<Geom> shapes_;
  std::unique_ptr<dxJointGroup, DestroyGroup> contacts_;
};

}  // namespace quadcore
