#pragma once

#include <ode/ode.h>

#include <memory>
#include <vector>

#include "constraint_rows.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore {

/// Return an upper bound of the reach of a body's shapes from its centre of mass [m].
struct Reach {
  std::size_t body;
  double length;
};

/// Finds contacts of a vehicle's collision shapes with the ground plane z = 0. Links of one model
/// do not collide with each other.
class GroundContact {
 public:
  /// \param bodies  one per link of the model, each at its link's centre of mass.
  /// \param max_correction  limit of every contact's correction [m/s].
  /// Throws InputError for a shape without contact model (a mesh).
  GroundContact(const Model& model, const std::vector<dBodyID>& bodies, double max_correction);

  /// Return the maximum number of contacts.
  std::size_t most() const { return contacts_.capacity(); }

  /// Of each shape.
  const std::vector<Reach>& reaches() const { return reaches_; }

  /// Return the contacts of the present poses, at most ten for each shape.
  const std::vector<Contact>& find();

  /// Return whether a shape may be below the ground within `time` [s] at the present velocities.
  /// Shapes of rotors are treated as turning only with the frame.
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
    Vector3d fdir1;  ///< direction of mu1 in the shape's axes
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
