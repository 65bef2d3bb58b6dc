#pragma once

#include <ode/ode.h>

#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "clear_ball.hpp"
#include "constraint_rows.hpp"
#include "geoms.hpp"
#include "pair_order.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/world.hpp"

namespace quadcore {

/// Return an upper bound of the reach of a body's shapes from its centre of mass [m].
struct Reach {
  std::size_t body;
  double length;
};

/// Return an upper bound of the distance of a model's shapes from the frame's centre of mass [m].
double reach_of_shapes(const Model& model);

/// Finds contacts of vehicles and of free bodies with each other, the ground plane and the
/// obstacles of a world, in Gazebo 11's order. Links of one model do not collide with each other,
/// unless the world says so.
class WorldContact {
 public:
  /// \param bodies  one per link of each vehicle, then the free bodies, each at its centre of mass.
  /// Throws InputError for a shape without contact model (a mesh).
  WorldContact(const std::vector<const Model*>& vehicles, const std::vector<dBodyID>& bodies,
               const World& world);

  /// Return the maximum number of points with the ground alone.
  std::size_t most_on_ground() const;
  /// Return the reach of each shape.
  const std::vector<Reach>& reaches() const { return reaches_; }
  /// Return whether there is a ground plane.
  bool has_ground() const { return has_ground_; }

  /// Return the contacts of the present poses in a world with one vehicle.
  /// \param unmoved  steps since each free body moved, behind those of the vehicles, which move in
  ///   every step; infinite before the first step
  const std::vector<Contact>& find(const std::vector<double>& unmoved);
  /// Return those without the vehicle.
  const std::vector<Contact>& find_free(const std::vector<double>& unmoved);
  /// Return those of the free bodies and some vehicles.
  /// \param vehicles  whether each vehicle takes part
  const std::vector<Contact>& find_among(const std::vector<char>& vehicles,
                                         const std::vector<double>& unmoved);

  /// Return whether a shape of the only vehicle may be in the ground or an obstacle within `time`
  /// [s] at the present velocities. Shapes of rotors are treated as turning only with the frame.
  bool is_ahead(double time);
  /// Return whether the vehicle does not touch an obstacle, apart from the ground plane, within
  /// `time` [s].
  /// \param p_WF, v_WF_W  position and velocity of the frame's centre of mass
  bool is_clear(const Vector3d& p_WFcm, const Vector3d& v_WFcm_W, double time);
  /// Return the same for the free bodies alone and shapes that reach so far [m].
  bool is_clear_of_free(const Vector3d& p_WFcm, const Vector3d& v_WFcm_W, double reach,
                        double time) const;

 private:
  /// A collision shape of a body, or of an obstacle.
  struct Shape {
    Geom geom;
    int body;  ///< -1 for one that stands still
    Surface surface;
    double slip1 = 0, slip2 = 0;
    double restitution = 0, restitution_speed = 0;
    std::shared_ptr<const TriangleMesh> mesh = {};  ///< null unless it is a mesh
    Bounds box = {};
  };
  using Shapes = std::vector<Shape>;
  /// A ball around all shapes of a free body.
  struct Ball {
    dBodyID body;
    double radius;  ///< from its centre of mass [m]
  };

  void add_obstacle(const Obstacle& obstacle);
  void add_free_bodies(const World& world, std::size_t first);
  void add_shape(const Collision& collision, const Link& link, std::size_t body);
  Bounds find_bounds(Shapes& shapes) const;
  void find_free_bounds(const std::vector<double>& unmoved);
  MovingModel find_vehicle(Shapes& shapes) const;
  const std::vector<Contact>& find_pairs();
  void collide(const ModelPair& pair);
  void meet(const Shape& one, const Shape& other);
  void touch(const Shape& one, const Shape& other);
  bool are_joined(const Shape& one, const Shape& other) const;
  bool is_ground_ahead(double time) const;
  bool is_obstacle_ahead(double time);
  Shapes& vehicle() { return models_.back(); }
  const Shapes& vehicle() const { return models_.back(); }

  const std::vector<dBodyID>& bodies_;
  Vector3d gravity_W_;
  double max_correction_;
  int max_contacts_;
  bool has_ground_;
  std::size_t still_ = 0;          ///< number of the models that stand still
  std::size_t first_vehicle_ = 0;  ///< index of the first vehicle among the models
  std::vector<Shapes> models_;     ///< obstacles, the newest shape first; free models; vehicles
  std::vector<Ball> balls_;        ///< of the free bodies
  std::set<std::pair<int, int>> joined_;  ///< free bodies that a joint connects
  std::vector<Reach> reaches_;
  double reach_ = 0;  ///< reach of all shapes from the frame's centre of mass [m]
  ClearBall clear_ball_;
  std::unique_ptr<PairOrder> order_;
  std::vector<MovingModel> moving_;  ///< free models; vehicles
  std::vector<std::pair<const Shape*, const Shape*>> of_meshes_;
  std::vector<dContactGeom> touching_;
  std::vector<Contact> contacts_;
};

}  // namespace quadcore
