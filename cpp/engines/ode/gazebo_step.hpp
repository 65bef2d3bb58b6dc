#pragma once

#include <ode/ode.h>

#include <array>
#include <cstdint>
#include <vector>

#include "constraint_rows.hpp"
#include "sweeps.hpp"

namespace quadcore {

/// A step of Gazebo 11's fork of ODE with its quick solver: projected Gauss-Seidel sweeps over the
/// constraint rows (Catto, "Iterative dynamics with temporal coherence", GDC 2005) with Gazebo's
/// order, relaxation and warm start. It solves twice from the same state: poses use the full
/// correction of the penetration, velocities a limited one. Upstream's QuickStep has neither this
/// order nor this relaxation, and shuffles its rows by a random generator that the whole process
/// shares. The result agrees with Gazebo's recording of take-off and landing within 1e-12 m.
class GazeboStep {
 public:
  /// Fractions of its velocities that a body loses in each step.
  struct Damping {
    double linear, angular;
  };
  struct Options {
    int iterations;
    double sor;
    Vector3d gravity_W;
    ConstraintRows::Options rows;
    std::vector<Damping> damping;  ///< of each body
  };

  /// Multipliers of a hinge's rows: force, and torque across the axis.
  using Multipliers = std::array<double, rows_per_hinge>;
  /// Initial multipliers of a step for each hinge in the solutions for poses and for velocities.
  struct WarmStart {
    Multipliers pose{}, velocity{};
  };

  /// Bodies, hinges and their order as in ConstraintRows.
  /// \param vehicle  number of bodies of the vehicles, which are the first; so are their hinges
  GazeboStep(const std::vector<dBodyID>& bodies, std::vector<Hinge> hinges,
             const std::vector<std::size_t>& order, const Options& options, std::size_t vehicle);

  /// Reserve memory for so many contacts, so that step() does not allocate.
  void reserve(std::size_t contacts);

  /// Advance all bodies by dt under the added forces.
  void step(const std::vector<Contact>& contacts, double dt) { step(contacts, dt, all()); }
  /// Advance all but the vehicle's bodies. Contacts of the vehicle must not be among the contacts.
  void step_free(const std::vector<Contact>& contacts, double dt) { step(contacts, dt, free()); }

  /// Return whether a hinge's correction in the present poses exceeds its limit.
  bool caps_hinges(double dt);

  /// Return the fraction of an error of the hinges' multipliers that remains after the sweeps in
  /// the present poses, or a fraction of at most `enough` that remains after fewer sweeps. It is
  /// measured by the energy of the accelerations of random errors from a seed. The warm start is
  /// discarded.
  double remaining_error(double dt, std::uint64_t seed, double enough);

  std::vector<WarmStart> warm_start;
  std::vector<char> asleep;  ///< whether each body sleeps; it does not move until another wakes it
  std::vector<double> unmoved;  ///< of these steps, those since each body moved; first infinite

 private:
  using Vector6 = ConstraintRow::Vector6;

  struct Body {
    double inverse_mass = 0;
    Matrix3d inverse_inertia_W;
    Vector6 velocity;           ///< linear, angular
    Vector6 free_acceleration;  ///< acceleration without constraints
    Vector6 moving;             ///< velocity that moves the pose
  };

  /// Additional data of a row for the sweeps.
  struct Prepared {
    Vector6 inverse_mass_J[2];  ///< for each body
    double relaxation;          ///< relaxation divided by the row's diagonal
  };

  BodyRange all() const { return {0, bodies_.size()}; }
  BodyRange vehicle() const { return {0, vehicle_}; }
  BodyRange free() const { return {vehicle_, bodies_.size()}; }
  void step(const std::vector<Contact>& contacts, double dt, const BodyRange& range);
  void read_bodies(const BodyRange& range);
  void prepare_rows();
  void order_rows();
  void put_hinge(std::size_t row);
  void put_row(std::size_t row);
  void begin(double dt);
  Vector6 inverse_mass_J(const ConstraintRow& row, int side) const;
  Vector6 constraint(std::size_t body, int solve) const;
  void add_multiplier(std::size_t row, const Sweeps::Two& multiplier);
  void damp(const BodyRange& range);
  void move(double dt, const BodyRange& range);

  const std::vector<dBodyID>& ode_bodies_;
  ConstraintRows constraints_;
  Options options_;
  std::vector<Body> bodies_;
  const std::vector<ConstraintRow>* rows_ = nullptr;
  Sweeps sweeps_;
  std::vector<Sweeps::Solved*> solved_;  ///< entry of each row in sweeps_
  std::vector<int> place_;               ///< index of each row among the rows of sweeps_
  std::vector<Prepared> prepared_;       ///< data of each row
  std::size_t vehicle_;                  ///< number of the vehicles' bodies
  std::size_t simple_hinges_ = 0;   ///< number of the first hinges with only Sweeps::Hinge rows
  std::size_t friction_begin_ = 0;  ///< first friction row in the order of sweeps_
};

}  // namespace quadcore
