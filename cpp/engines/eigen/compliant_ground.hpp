#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "contact_stiffness.hpp"
#include "gyrostat.hpp"
#include "laws/ahead.hpp"
#include "laws/contact.hpp"
#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/plugin/loads.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore {

/// The ground plane z = 0 under a gyrostat. Each contact point has a force by laws/contact.hpp.
/// Each shape has one bristle, a spring between the ground and the centre of pressure. It bends as
/// the shape moves along the ground, turns and rolls, and slips at the friction limit (P. R. Dahl,
/// "Solid friction damping of mechanical vibrations", AIAA Journal 14, 1976). The stiffness is as
/// high as the time step allows, see contact_stiffness.hpp.
class CompliantGround {
 public:
  /// Throws InputError for a shape without contact model (a mesh). The model must outlive this
  /// object.
  CompliantGround(const Model& model, const Gyrostat& body, const Surface& ground);

  /// Return whether the vehicle may touch the ground within dt [s], given the height [m] and upward
  /// velocity [m/s] of its centre of mass.
  bool is_near(double z_WC, double v_z, double dt) const {
    return z_WC < reach_ + laws::ahead(std::abs(v_z), dt);
  }
  /// Return the reach of the shapes from the vehicle's centre of mass [m]; negative without shapes.
  double reach() const { return reach_; }
  /// Return whether the vehicle may touch the ground within dt [s], given its motion.
  bool is_ahead(const Kinematics& kinematics, double dt) const;
  /// Throw Error if the vehicle is so deep in the ground that the springs would throw it up.
  void refuse_deep(const Kinematics& kinematics, double dt) const;

  /// Begin a Runge-Kutta step of dt [s], in which add_forces() is called at each stage.
  void begin(double dt);
  void add_forces(const Kinematics& kinematics, Loads& loads);
  void end();

  /// Return the bristles, the only memory of the contact.
  void clear();
  std::size_t saved_size() const { return Bent::SizeAtCompileTime * shapes_.size(); }
  double* save(double* to) const;
  const double* restore(const double* from);

  /// Return warnings about tags of Gazebo's solver that have no effect here.
  std::vector<std::string> warnings() const;

 private:
  /// Components of laws::Resistance, in world axes.
  using Bent = laws::Resistance;
  struct Spring {
    double stiffness = 0;   ///< N/m
    double relaxation = 0;  ///< s
  };
  struct Shape {
    std::size_t link;
    const Collision* collision;
    Matrix3d R_LS;
    double reach;  ///< distance of its farthest point from its centre [m]
    bool turns;    ///< belongs to a rotor and is not a body of revolution about its axis
    StableContact stable;
    double hardest;                    ///< maximum stiffness, that of its surface [N/m]
    double mu1, mu2;                   ///< friction along fdir1 and across it
    Spring press, rub;                 ///< springs of this step
    Bent bristle = Bent::Zero();       ///< [m]
    Bent bent = Bent::Zero();          ///< bristle at this stage [m]
    Bent sum = Bent::Zero();           ///< weighted sum of its Runge-Kutta rates
    double force = 0;                  ///< normal force [N]
    Vector3d friction = {0, 0, 0};     ///< friction limits along its axes and about the normal [N]
    Eigen::Vector2d axis_W = {0, -1};  ///< direction of mu1, unit
  };
  struct Motion;

  static double lowest(const Shape& shape, const Motion& motion);
  static Spring spring(double stable, double hardest, double dt);
  Motion motion_of(const Kinematics& kinematics, std::size_t link) const;
  Motion motion_of(const Kinematics& kinematics, const Shape& shape) const;
  void press(Shape& shape, const Kinematics& kinematics, Loads& loads);
  Bent rub(Shape& shape, const Bent& rate);
  static Bent possible(const Shape& shape, const Bent& wanted_W);

  const Model& model_;
  double weight_;  ///< weight of the vehicle under Gazebo's gravity [N]
  double reach_;   ///< reach of the shapes from the vehicle's centre of mass [m]
  std::vector<Shape> shapes_;
  double dt_ = 0;
  int stage_ = 0;
};

}  // namespace quadcore
