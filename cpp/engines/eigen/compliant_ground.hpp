#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "bristle.hpp"
#include "contact_stiffness.hpp"
#include "gyrostat.hpp"
#include "laws/ahead.hpp"
#include "link_motion.hpp"
#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/plugin/loads.hpp"
#include "quadcore/plugin/model.hpp"

namespace quadcore {

/// The ground plane z = 0 under a gyrostat. Each contact point has a force by laws/contact.hpp, and
/// each shape a bristle for friction. The stiffness is as high as the time step allows, see
/// contact_stiffness.hpp.
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
  /// Return whether the vehicle may touch the ground within dt [s], given its motion.
  bool is_ahead(const Kinematics& kinematics, double dt) const;
  /// Throw Error if the vehicle is so deep in the ground that the springs would throw it up.
  void refuse_deep(const Kinematics& kinematics, double dt) const;

  /// Begin a Runge-Kutta step of dt [s], in which add_forces() is called at each stage.
  void begin(double dt);
  void add_forces(const Kinematics& kinematics, Loads& loads);
  void end();

  /// Forget the bristles, the only memory of the contact.
  void clear();
  std::size_t saved_size() const { return Bristle::saved_size * shapes_.size(); }
  double* save(double* to) const;
  const double* restore(const double* from);

 private:
  struct Shape {
    std::size_t link;
    const Collision* collision;
    Matrix3d R_LS;
    double reach;  ///< distance of its farthest point from its centre [m]
    bool turns;    ///< belongs to a rotor and is not a body of revolution about its axis
    StableContact stable;
    double hardest;   ///< maximum stiffness, that of its surface [N/m]
    double mu1, mu2;  ///< friction along fdir1 and across it
    Spring press;     ///< spring of each point in this step
    Bristle bristle;
  };

  static double lowest(const Shape& shape, const LinkMotion& motion);
  void press(Shape& shape, const Kinematics& kinematics, Loads& loads);

  const Model& model_;
  double weight_;  ///< weight of the vehicle under Gazebo's gravity [N]
  double reach_;   ///< reach of the shapes from the vehicle's centre of mass [m]
  std::vector<Shape> shapes_;
  double dt_ = 0;
  int stage_ = 0;
};

}  // namespace quadcore
