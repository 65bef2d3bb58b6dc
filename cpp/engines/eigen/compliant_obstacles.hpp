#pragma once

#include <cstddef>
#include <vector>

#include "bristle.hpp"
#include "clear_ball.hpp"
#include "contact_stiffness.hpp"
#include "gyrostat.hpp"
#include "link_motion.hpp"
#include "obstacle_depth.hpp"
#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/plugin/loads.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/obstacle.hpp"

namespace quadcore {

/// Obstacles around a gyrostat. Points spread over the vehicle's shapes have springs by
/// laws/contact.hpp, along the shortest way out of each obstacle. These forces have a potential, so
/// that an impact gives back at most the energy that it took. Each shape has a bristle for friction
/// across the mean normal. Opposite normals, as of a wedged vehicle, count as one.
class CompliantObstacles {
 public:
  /// Throws InputError for a mesh, of the vehicle or among the obstacles. The model must outlive
  /// this object.
  CompliantObstacles(const Model& model, const Gyrostat& body, std::vector<Obstacle> obstacles);

  /// Return whether the vehicle may touch an obstacle within dt [s], given the position and speed
  /// of its centre of mass. Away from obstacles, this takes one comparison.
  bool is_near(const Vector3d& p_WC, double speed, double dt);
  /// Return the same given its motion, after is_near().
  bool is_ahead(const Kinematics& kinematics, double dt) const;
  /// Throw Error if the vehicle is so deep in an obstacle that the springs would throw it off.
  void refuse_deep(const Kinematics& kinematics, double dt);

  /// Begin a Runge-Kutta step of dt [s], in which add_forces() is called at each stage.
  void begin(double dt);
  void add_forces(const Kinematics& kinematics, Loads& loads);
  void end();

  /// Forget the bristles and their axes, the only memory of the contact.
  void clear();
  std::size_t saved_size() const { return (Bristle::saved_size + 3) * shapes_.size(); }
  double* save(double* to) const;
  const double* restore(const double* from);

 private:
  struct Shape {
    std::size_t link;
    const Collision* collision;
    std::vector<Vector3d> points_S;  ///< in its axes [m]
    Matrix3d R_FL_at_zero;           ///< axes of the link that does not turn
    Matrix3d R_LS;
    double radius;  ///< of the ball about each point: that of a sphere, else 0 [m]
    double reach;   ///< distance of its farthest point from its centre [m]
    bool revolves;  ///< whether it is a body of revolution about the joint of its rotor
    StableContact stable;
    Bristle bristle;
    Vector3d axis_W = {0, 0, 0};  ///< of the friction in the previous step; zero without contact
    Vector3d next_axis_W = {0, 0, 0};  ///< of the friction at this stage

    /// Return whether its points turn with a rotor.
    bool turns() const { return link > 0 && !revolves; }
  };
  /// A touching point, for the extent of the contact patch.
  struct Point {
    Vector3d p_W;
    double force;
  };
  struct Touch {
    const Obstacle* obstacle;
    ObstacleDepth found;
  };

  void press(Shape& shape, const Kinematics& kinematics, Loads& loads);
  /// Return an axis along a normal that does not turn round from step to step.
  static Vector3d align(const Vector3d& normal_W, const Vector3d& axis_W);
  static void add_pressing(const Kinematics& kinematics, const Shape& shape, const Vector3d& f_W,
                           const Vector3d& tau_W, Loads& loads);
  /// Collect the deepest obstacles that a ball touches.
  void find_touches(const Vector3d& p_W, double radius);

  const Model& model_;
  double weight_;  ///< weight of the vehicle under Gazebo's gravity [N]
  double reach_;   ///< reach of the shapes from the vehicle's centre of mass [m]
  std::vector<Obstacle> obstacles_;
  ClearBall clear_;
  std::vector<Shape> shapes_;
  std::vector<const Obstacle*> near_;        ///< obstacles within reach in this step
  std::vector<const Obstacle*> near_shape_;  ///< those of the present shape
  std::vector<Point> points_;                ///< touching points of the present shape
  std::vector<Touch> touches_;               ///< those of the present point
  double dt_ = 0;
  int stage_ = 0;
};

}  // namespace quadcore
