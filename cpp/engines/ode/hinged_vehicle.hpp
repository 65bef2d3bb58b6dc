#pragma once

#include <ode/ode.h>

#include <vector>

#include "gazebo_step.hpp"
#include "hinged_flight.hpp"
#include "hinged_model.hpp"
#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/plugin/loads.hpp"

namespace quadcore {

/// A vehicle's bodies as HingedFlight takes them, beside those in an ODE world.
class HingedVehicle {
 public:
  /// \param max_correction  of a hinge [m/s, rad/s]
  HingedVehicle(const Bodies& bodies, const World& world, double max_correction);

  /// Takes over the state of bodies in ODE, one for each link.
  void take(const std::vector<dBodyID>& bodies);
  /// Takes over the forces that have been added to them.
  void take_forces(const std::vector<dBodyID>& bodies);
  /// Gives them this state, and no forces.
  void give(const std::vector<dBodyID>& bodies) const;

  /// Puts loads on the vehicle in place of all forces; joints damp themselves.
  void push(const Loads& loads);
  /// Advances by dt, with the gyroscopic torque of each body by itself or without. False, and the
  /// vehicle stays where it is, if a hinge asks for a larger correction than is solved for.
  bool advance(double dt, bool gyroscopic) { return calls_.advance(flight_, dt, gyroscopic); }
  /// Writes how the vehicle moves.
  void show(Kinematics& kinematics) const;

  /// Calls work(i, what hinge i has exerted in the last step) for each hinge.
  template <class Work>
  void for_each_hinge(const Work& work) const {
    calls_.find_hinge_loads(flight_);
    for (std::size_t i = 0; i + 1 < flight_.tree.bodies; ++i) work(i, multipliers(i));
  }

  /// Orientation of body i in the world.
  Matrix3d R_WB(std::size_t i) const;

  /// Whether body i keeps further than `reach` [m] above the ground for a time [s], falling freely.
  bool is_high(std::size_t i, double reach, double time, double gravity_z) const;

 private:
  struct Calls {
    int width;
    void (*read)(const HingedFlight&);
    void (*clear)(const HingedFlight&);
    void (*push)(const HingedFlight&, const FlightLoads&);
    bool (*advance)(const HingedFlight&, double, bool);
    void (*show)(const HingedFlight&, const ShownFlight&);
    void (*find_hinge_loads)(const HingedFlight&);
  };
  static Calls calls(int width);

  GazeboStep::Multipliers multipliers(std::size_t hinge) const;
  double* state_of(std::size_t body) const;
  double* work_of(std::size_t body, std::size_t number) const;

  HingedModel model_;
  std::vector<std::size_t> rotors_;     ///< of each, its joint
  std::vector<Matrix3d> R_PC_at_zero_;  ///< of each hinge
  LaneNumbers constants_, state_, work_, soft_;
  HingedFlight flight_;  ///< points into the members above
  Calls calls_;
};

}  // namespace quadcore
