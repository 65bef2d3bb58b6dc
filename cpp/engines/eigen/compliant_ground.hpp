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

/// The ground plane z = 0 under a gyrostat: at each point where a shape touches it a force by
/// laws/contact.hpp; for each shape one bristle, a spring between the ground and the centre of what
/// presses, which bends as the shape is moved along the ground, turns and rolls, and slips where it
/// would carry more than is possible (P. R. Dahl, "Solid friction damping of mechanical
/// vibrations", AIAA Journal 14, 1976). So stiff as stays stable at the step: see
/// contact_stiffness.hpp.
class CompliantGround {
 public:
  /// Throws InputError on a shape that cannot collide (a mesh). The model must outlive it.
  CompliantGround(const Model& model, const Gyrostat& body);

  /// Whether, for all that its height [m] and upward velocity [m/s] tell, the vehicle whose centre
  /// of mass these are of may touch the ground within dt [s].
  bool is_near(double z_WC, double v_z, double dt) const {
    return z_WC < reach_ + laws::ahead(std::abs(v_z), dt);
  }
  /// Of the shapes from the vehicle's centre of mass [m]; negative without any.
  double reach() const { return reach_; }
  /// Whether, for all that its motion tells, it may do so.
  bool is_ahead(const Kinematics& kinematics, double dt) const;
  /// Throws Error if the vehicle is so deep in the ground that the springs would throw it up.
  void refuse_deep(const Kinematics& kinematics, double dt) const;

  /// Begins a Runge-Kutta step of dt [s], in which add_forces() is called at each stage.
  void begin(double dt);
  void add_forces(const Kinematics& kinematics, Loads& loads);
  void end();

  /// The bristles, the only memory of what touches.
  void clear();
  std::size_t saved_size() const { return Bent::SizeAtCompileTime * shapes_.size(); }
  double* save(double* to) const;
  const double* restore(const double* from);

  /// Of tags of Gazebo's solver that have no meaning here.
  std::vector<std::string> warnings() const;

 private:
  /// Along what laws::Resistance resists; in the world's axes.
  using Bent = laws::Resistance;
  struct Spring {
    double stiffness = 0;   ///< N/m
    double relaxation = 0;  ///< s
  };
  struct Shape {
    std::size_t link;
    const Collision* collision;
    Matrix3d R_LS;
    double reach;  ///< from its centre [m]
    bool turns;    ///< with a rotor that is not one of revolution
    StableContact stable;
    double hardest;                    ///< stiffness of its surface [N/m]
    double mu1, mu2;                   ///< friction along fdir1 and across it
    Spring press, rub;                 ///< of this step
    Bent bristle = Bent::Zero();       ///< [m]
    Bent bent = Bent::Zero();          ///< the same at this stage
    Bent sum = Bent::Zero();           ///< of its rates, by Runge-Kutta's weights
    double force = 0;                  ///< that presses [N]
    Vector3d friction = {0, 0, 0};     ///< the most along its axes and about the normal [N]
    Eigen::Vector2d axis_W = {0, -1};  ///< along which mu1 acts, unit
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
  double weight_;  ///< of the vehicle where Gazebo's gravity is [N]
  double reach_;   ///< of the shapes from the vehicle's centre of mass [m]
  std::vector<Shape> shapes_;
  double dt_ = 0;
  int stage_ = 0;
};

}  // namespace quadcore
