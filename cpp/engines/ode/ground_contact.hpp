#pragma once

#include <ode/ode.h>

#include <memory>
#include <vector>

#include "constraint_rows.hpp"
#include "quadcore/model.hpp"

namespace quadcore {

/// Finds where a vehicle's collision shapes touch the ground plane z = 0. Links of one model do not
/// collide with each other.
class GroundContact {
 public:
  /// \param bodies  one per link of the model, each at its link's centre of mass.
  /// Throws InputError on a shape that cannot collide (a mesh).
  GroundContact(const Model& model, const std::vector<dBodyID>& bodies);

  /// The contacts of the present poses, at most ten for each shape.
  const std::vector<Contact>& find();

  /// What Gazebo 11 makes of a model on its ground plane, for steps of dt.
  static Surface surface(double dt);

 private:
  struct DestroyGeom {
    void operator()(dxGeom* geom) const { dGeomDestroy(geom); }
  };
  using Geom = std::unique_ptr<dxGeom, DestroyGeom>;
  struct Shape {
    Geom geom;
    std::size_t body;
  };

  Geom plane_;
  std::vector<Shape> shapes_;
  std::vector<Contact> contacts_;
};

}  // namespace quadcore
