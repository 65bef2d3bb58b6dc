#pragma once

#include <ode/ode.h>

#include <vector>

#include "quadcore/plugin/spatial.hpp"

namespace quadcore {

/// Kind of a hinge; see Hinge for its axes.
enum class HingeKind { revolute, prismatic, universal, ball };

/// A hinge between two bodies, or a body and the world; vectors in the axes of the body they belong
/// to. The two axes coincide, but those of a universal joint are perpendicular.
struct Hinge {
  static constexpr std::size_t world = static_cast<std::size_t>(-1);

  std::size_t child, parent;                           ///< indices of the bodies, or `world`
  Vector3d anchor_C, anchor_P;                         ///< from each body's centre of mass [m]
  Vector3d axis_C, axis_P;                             ///< unit
  double friction = 0;                                 ///< dry, about the axis [N m]
  double implicit_damping = 0;                         ///< about the axis [N m s/rad]
  bool locked = false;                                 ///< held at angle zero
  Quaterniond q_PC_at_zero = Quaterniond::Identity();  ///< orientation of the child at angle zero
  HingeKind kind = HingeKind::revolute;
  double lower = -1e16, upper = 1e16;  ///< limits of the position [rad, m]
};

/// Present geometry of a hinge; vectors in W.
struct HingePlace {
  Vector3d anchor_C_W, anchor_P_W;  ///< from each body's centre of mass [m]
  Vector3d axis_W;                  ///< axis of the child
  Vector3d gap_W;                   ///< parent's anchor from the child's [m]
  Vector3d tilt_W;                  ///< rotation from the child's axis to the parent's [rad]

  HingePlace(const Hinge& hinge, const Vector3d& p_WC, const Matrix3d& R_WC, const Vector3d& p_WP,
             const Matrix3d& R_WP);
};

/// Contact parameters of two shapes.
struct SurfacePair {
  double stiffness, damping;  ///< N/m, N s/m
  double mu1, mu2;            ///< friction along the first direction and across it
  double max_correction;      ///< limit of the correction in the solution for velocities [m/s]
  double slip1, slip2;        ///< softness of the friction along and across [m/(N s)]
  double bounce = 0;          ///< coefficient of restitution
  double bounce_speed = 0;    ///< slower impacts do not bounce [m/s]
};

/// A point where a body touches something that stands still or another body.
struct Contact {
  std::size_t body;
  Vector3d position_W;  ///< m
  Vector3d normal_W;    ///< unit, towards the body
  Vector3d fdir1_W;     ///< first direction of friction, any length; zero: ODE's choice
  double depth;         ///< depth of the penetration to correct [m]
  SurfacePair surface;
  int other = -1;  ///< the other body, or -1
};

/// A range of bodies.
struct BodyRange {
  std::size_t begin, end;
  bool contains(std::size_t body) const { return body >= begin && body < end; }
};

/// One row J v = correction of the constraints between up to two bodies, in ODE's terms.
struct ConstraintRow {
  using Vector6 = Eigen::Matrix<double, 6, 1>;

  int body[2] = {-1, -1};                             ///< the second is -1 for the ground
  Vector6 J[2] = {Vector6::Zero(), Vector6::Zero()};  ///< linear, angular part for each body
  double correction = 0;                              ///< velocity that removes the position error
  double max_correction = 0;  ///< cap of the correction where velocities are solved for
  double cfm = 0;
  double low = 0, high = 0;  ///< bounds of the multiplier
  double friction = 0;       ///< for a friction row: bound per multiplier of its normal
  int normal = -1;           ///< for a friction row: the row of its normal
  int hinge = -1;            ///< for a hinge row: its hinge
  int hinge_row = 0;         ///< for a hinge row: index within the hinge
};

/// Rows of a hinge: three for the anchor, two for the axis, one for friction, implicit damping or a
/// lock.
constexpr int rows_per_hinge = 6;

/// Writes the rows of hinges and contacts in the order of Gazebo 11's ODE. It traverses an island
/// from its newest body and a body's joints from the newest, with contacts before hinges. Gazebo
/// creates bodies and hinges in the order of its SDF.
class ConstraintRows {
 public:
  struct Options {
    double erp, cfm;
    double max_hinge_correction;  ///< limit of a hinge's correction in the solution for velocities
                                  ///< [m/s, rad/s]
  };

  /// Each hinge carries its child; `order` contains the indices of the bodies, the oldest first.
  ConstraintRows(const std::vector<dBodyID>& bodies, std::vector<Hinge> hinges,
                 const std::vector<std::size_t>& order, const Options& options);

  /// Reserve memory for so many contacts, so that build() does not allocate.
  void reserve(std::size_t contacts);
  std::size_t most_rows() const { return rows_.capacity(); }

  /// Return the rows of the islands of some bodies. Bodies outside the range are in no island.
  /// \param asleep  whether each body sleeps: it starts no island, but another one may wake it
  const std::vector<ConstraintRow>& build(const std::vector<Contact>& contacts, double dt,
                                          const BodyRange& range, std::vector<char>& asleep);
  const std::vector<Hinge>& hinges() const { return hinges_; }

 private:
  void visit(std::size_t body, const std::vector<Contact>& contacts, double dt,
             std::vector<char>& asleep);
  void reach(std::size_t body, std::vector<char>& asleep);
  void add_hinge(std::size_t index, double dt);
  void add_along(const Hinge& hinge, double position, double dt, ConstraintRow row);
  double speed_along(const ConstraintRow& row) const;
  void add_contact(const Contact& contact, double dt);

  const std::vector<dBodyID>& bodies_;
  std::vector<Hinge> hinges_;
  std::vector<std::size_t> newest_first_;         ///< indices of the bodies
  std::vector<std::size_t> newest_hinges_first_;  ///< indices of the hinges
  Options options_;
  std::vector<ConstraintRow> rows_;
  std::vector<char> body_tagged_, hinge_tagged_, contact_tagged_;
  std::vector<std::size_t> stack_;
};

}  // namespace quadcore
