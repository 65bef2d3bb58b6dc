#pragma once

#include "laws/contact.hpp"

namespace quadcore {

/// A spring with a damper.
struct Spring {
  double stiffness = 0;   ///< N/m
  double relaxation = 0;  ///< s
};

/// Return the stiffest stable spring, limited by the surface; a softer one has the same damping
/// ratio.
/// \param stable   maximum stiffness for a step of 1 s [kg], see contact_stiffness.hpp
/// \param hardest  maximum stiffness, that of the surface [N/m]
Spring make_spring(double stable, double hardest, double dt);

/// Points of a shape that press on a surface, in axes whose z is the normal of the surface.
struct PressedPatch {
  double pressing = 0;            ///< sum of the normal forces [N]
  double square = 0;              ///< sum of forces times squared distances from the centre [N m^2]
  double reach = 0;               ///< distance of the shape's farthest point from its centre [m]
  Vector3d friction = {0, 0, 0};  ///< friction limits along its axes and about the normal [N]
  Vector3d direction = {0, 0, 0};  ///< direction of the first axis of friction
};

/// Resistance of a patch, in the axes of PressedPatch.
struct PatchResistance {
  Vector3d along;    ///< force at the centre of pressure [N]
  Vector3d turning;  ///< torque [N m]
};

/// A spring between a surface and the centre of pressure of a shape. It bends as the shape moves
/// along the surface, turns and rolls, and slips at the friction limit (P. R. Dahl, "Solid friction
/// damping of mechanical vibrations", AIAA Journal 14, 1976). It is integrated by the classical
/// Runge-Kutta method.
class Bristle {
 public:
  /// Components of laws::Resistance.
  using Bent = laws::Resistance;

  /// Begin a step of dt [s].
  void begin(const Spring& spring);
  /// Return the resistance at the velocity of the centre of pressure [m/s] and an angular velocity
  /// [rad/s], and advance to the next of four stages.
  PatchResistance resist(const PressedPatch& patch, const Vector3d& v, const Vector3d& w, int stage,
                         double dt);
  /// Advance to the next stage without contact.
  void release(int stage, double dt);
  void end(double dt);

  void clear() { bristle_.setZero(); }
  static constexpr std::size_t saved_size = Bent::SizeAtCompileTime;
  double* save(double* to) const;
  const double* restore(const double* from);

 private:
  Bent rub(const Bent& rate, int stage, double dt);
  Bent limit(const Bent& wanted) const;

  Spring spring_;
  Bent bristle_ = Bent::Zero();     ///< [m]
  Bent bent_ = Bent::Zero();        ///< bristle at this stage [m]
  Bent sum_ = Bent::Zero();         ///< weighted sum of its Runge-Kutta rates
  double force_ = 0;                ///< normal force [N]
  Vector3d friction_ = {0, 0, 0};   ///< as in PressedPatch
  Eigen::Vector2d axis_ = {0, -1};  ///< direction of the first axis of friction, unit
};

}  // namespace quadcore
