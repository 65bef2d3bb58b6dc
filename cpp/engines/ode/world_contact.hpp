#pragma once

#include <ode/ode.h>

#include <memory>
#include <vector>

#include "clear_ball.hpp"
#include "constraint_rows.hpp"
#include "pair_order.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/world.hpp"

namespace quadcore {

/// Return an upper bound of the reach of a body's shapes from its centre of mass [m].
struct Reach {
  std::size_t body;
  double length;
};

/// Finds contacts of a vehicle's collision shapes with the ground plane and the obstacles of a
/// world, in Gazebo 11's order. Links of one model do not collide with each other.
class WorldContact {
 public:
  /// \param bodies  one per link of the model, each at its link's centre of mass.
  /// Throws InputError for a shape without contact model (a mesh).
  WorldContact(const Model& model, const std::vector<dBodyID>& bodies, const World& world);

  /// Return the maximum number of points with the ground alone.
  std::size_t most_on_ground() const;
  /// Return the reach of each shape.
  const std::vector<Reach>& reaches() const { return reaches_; }
  /// Return whether there is a ground plane.
  bool has_ground() const { return has_ground_; }

  /// Return the contacts of the present poses.
  const std::vector<Contact>& find();

  /// Return whether a shape may be in the ground or an obstacle within `time` [s] at the present
  /// velocities. Shapes of rotors are treated as turning only with the frame.
  bool is_ahead(double time);
  /// Return whether the vehicle does not touch an obstacle, apart from the ground plane, within
  /// `time` [s].
  /// \param p_WF, v_WF_W  position and velocity of the frame's centre of mass
  bool is_clear(const Vector3d& p_WFcm, const Vector3d& v_WFcm_W, double time);

 private:
  struct DestroyGeom {
    void operator()(dxGeom* geom) const { dGeomDestroy(geom); }
  };
  using Geom = std::unique_ptr<dxGeom, DestroyGeom>;
  struct Shape {
    Geom geom;
    std::size_t body;
    Surface surface;
    Bounds box = {};
  };
  struct Solid {
    Geom geom;
    Surface surface;
    double slip1, slip2;
    Bounds box;
  };

  void add_obstacle(const Obstacle& obstacle);
  void add_shape(const Collision& collision, const Model& model, std::size_t link,
                 const std::vector<dBodyID>& bodies);
  Bounds find_bounds();
  void collide(const ModelPair& pair);
  void touch(const Shape& shape, const Solid& solid, bool solid_first);
  bool is_ground_ahead(double time) const;
  bool is_obstacle_ahead(double time);

  const std::vector<dBodyID>& bodies_;
  Vector3d gravity_W_;
  double max_correction_;
  int max_contacts_;
  bool has_ground_;
  std::vector<std::vector<Solid>> models_;  ///< shapes of each obstacle's model, the newest first
  std::vector<Shape> shapes_;
  std::vector<Reach> reaches_;
  double reach_ = 0;  ///< reach of all shapes from the frame's centre of mass [m]
  ClearBall clear_ball_;
  std::unique_ptr<PairOrder> order_;
  std::vector<dContactGeom> touching_;
  std::vector<Contact> contacts_;
};

}  // namespace quadcore
