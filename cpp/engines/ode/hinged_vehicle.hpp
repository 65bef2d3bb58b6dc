#pragma once

#include <ode/ode.h>

#include <vector>

#include "gazebo_step.hpp"
#include "hinged_flight.hpp"
#include "hinged_model.hpp"
#include "quadcore/lane_width.hpp"
#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/plugin/loads.hpp"

namespace quadcore {

/// A vehicle's bodies for HingedFlight, in addition to those in an ODE world.
class HingedVehicle {
 public:
  /// \param max_correction  maximum correction of a hinge [m/s, rad/s]
  HingedVehicle(const Bodies& bodies, const World& world, double max_correction);

  /// Copy the state of bodies in ODE, one for each link.
  void take(const std::vector<dBodyID>& bodies);
  /// Copy the forces that have been added to them.
  void take_forces(const std::vector<dBodyID>& bodies);
  /// Set their state to this one, without forces.
  void give(const std::vector<dBodyID>& bodies) const;

  /// Replace all forces on the vehicle by loads; joint damping is added automatically.
  void push(const Loads& loads);
  /// Set the forces on the bodies to those of laws in the motion that was shown. Returns false if
  /// they are not finite.
  bool push(const LawViews& laws, Kinematics& shown);
  /// Advance by dt, with the gyroscopic torque of each body or without. Returns false without a
  /// motion if a hinge requires a correction beyond the maximum.
  bool advance(double dt, bool gyroscopic) { return calls_.advance(flight_, dt, gyroscopic); }
  /// Write the motion of the vehicle.
  void show(Kinematics& kinematics) const;

  /// Call work(i, load of hinge i in the last step) for each hinge.
  template <class Work>
  void for_each_hinge(const Work& work) const {
    calls_.find_hinge_loads(flight_);
    for (std::size_t i = 0; i + 1 < flight_.tree.bodies; ++i) work(i, multipliers(i));
  }

  /// Return the position of the frame's centre of mass in the world [m].
  Vector3d position() const;
  /// Return its velocity in world axes [m/s].
  Vector3d velocity() const;
  /// Return the orientation of body i in the world.
  Matrix3d R_WB(std::size_t i) const;

  /// Return whether body i in free fall stays more than `reach` [m] above the ground for a time
  /// [s].
  bool is_high(std::size_t i, double reach, double time, double gravity_z) const;

 private:
  struct Calls {
    int width;
    void (*read)(const HingedFlight&);
    void (*clear)(const HingedFlight&);
    void (*push)(const HingedFlight&, const FlightLoads&);
    bool (*push_laws)(const HingedFlight&, const LawViews&, const ShownFlight&);
    bool (*advance)(const HingedFlight&, double, bool);
    void (*show)(const HingedFlight&, const ShownFlight&);
    void (*find_hinge_loads)(const HingedFlight&);
  };
  static Calls calls(int width);

  GazeboStep::Multipliers multipliers(std::size_t hinge) const;
  double* state_of(std::size_t body) const;
  Vector3d vector_of(std::size_t body, std::size_t row) const;
  double* work_of(std::size_t body, std::size_t number) const;

  HingedModel model_;
  std::vector<std::size_t> rotors_;     ///< joint of each rotor
  std::vector<Matrix3d> R_PC_at_zero_;  ///< orientation of each hinge at angle zero
  LaneNumbers constants_, state_, work_, soft_;
  HingedFlight flight_;  ///< points into the members above
  Calls calls_;
};

}  // namespace quadcore
