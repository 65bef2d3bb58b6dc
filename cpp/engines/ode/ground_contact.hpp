#pragma once

#include <ode/ode.h>

#include <memory>
#include <vector>

#include "constraint_rows.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore {

/// How far the shapes of a body reach from its centre of mass [m], at most.
struct Reach {
  std::size_t body;
  double length;
};

/// Finds where a vehicle's collision shapes touch the ground plane z = 0. Links of one model do not
/// collide with each other.
class GroundContact {
 public:
  /// \param bodies  one per link of the model, each at its link's centre of mass.
  /// \param max_correction  cap of every contact's correction [m/s].
  /// Throws InputError on a shape that cannot collide (a mesh).
  GroundContact(const Model& model, const std::vector<dBodyID>& bodies, double max_correction);

  /// As many contacts as there can be.
  std::size_t most() const { return contacts_.capacity(); }

  /// Of each shape.
  const std::vector<Reach>& reaches() const { return reaches_; }

  /// The contacts of the present poses, at most ten for each shape.
  const std::vector<Contact>& find();

  /// Whether a shape may be below the ground within `time` [s], by the present velocities. Shapes
  /// of rotors count as turning with the frame alone.
  bool is_ahead(double time, double gravity_z) const;

 private:
  struct DestroyGeom {
    void operator()(dxGeom* geom) const { dGeomDestroy(geom); }
  };
  using Geom = std::unique_ptr<dxGeom, DestroyGeom>;
  struct Shape {
    Geom geom;
    std::size_t body;
    SurfacePair surface;
    Vector3d fdir1;  ///< in the shape's axes
    double min_depth;
    int max_contacts;
  };

  const std::vector<dBodyID>& bodies_;
  Geom plane_;
  std::vector<Shape> shapes_;
  std::vector<Reach> reaches_;
  std::vector<Contact> contacts_;
};

}  // namespace quadcore
