#pragma once

#include "quadcore/control/actuation.hpp"
#include "quadcore/control/wrench_controller.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

struct LaneController;

/// A controller from odometry and reference to rotor speeds. Immutable; the caller owns the state,
/// which is all zero at the start.
class Controller {
 public:
  /// Throws InputError for an unknown controller or parameter, or an unsuitable vehicle.
  Controller(const std::string& name, const VehicleDescription& vehicle, const Values& values,
             const std::vector<double>& spins = {});

  /// Return the parameters of a controller, of the lag compensation and of the model errors.
  static std::vector<TagSpec> table(const std::string& name);
  /// Return the number of state values of a controller for so many rotors.
  static std::size_t state_size(const std::string& name, std::size_t rotors) {
    return Actuation::state_size(rotors) + find_controller(name).memory_size;
  }

  /// Return the number of state values of this controller.
  std::size_t state_size() const { return Actuation::state_size(rotors()) + memory_size_; }
  /// Return the number of driven rotors.
  std::size_t rotors() const { return model_.rotors.size(); }
  /// Compute the speeds to command until the next call. If the remaining rotors cannot yaw the
  /// hovering vehicle in both directions, yaw control is dropped and only the yaw rate is damped.
  /// \param period  time since the last call and until the next [s]
  /// \param speeds  (rotors(),) signed [rad/s]
  /// \param flat    flat state of the reference as feeds() requires; null: computed if needed
  void command(double period, const Odometry& now, const Reference& wanted, double* state,
               double* speeds, const FlatState* flat = nullptr) const;
  /// Compute the speeds for a demand of the control law.
  void act(double period, const Demand& demand, double* state, double* speeds) const {
    actuation_.command(period, demand, state, speeds);
  }
  /// Return the controller for the lanes of a batch, or null if it is only for single vehicles.
  /// Whole rotors are assumed.
  /// \param period  time between calls [s]
  std::shared_ptr<const LaneController> in_lanes(double period) const;
  /// Return the flat state that command() uses.
  WrenchController::Feeds feeds() const { return wrench_controller_->feeds(); }
  /// Set the remaining fraction of a rotor's thrust and torque.
  void set_remaining(std::size_t rotor, double left, double* state) const {
    actuation_.set_remaining(rotor, left, state);
  }
  /// Set the period of the next calls, from which the state's fractions of a change follow.
  void set_period(double period, double* state) const { actuation_.set_period(period, state); }
  /// Return whether a demand has been given.
  static bool has_begun(const double* state) { return Actuation::has_begun(state); }
  /// Return whether no rotor has lost thrust or torque.
  bool has_whole_rotors(const double* state) const { return actuation_.are_whole(state); }
  /// Return whether the last demand could not be met.
  static bool saturated(const double* state) { return Actuation::saturated(state); }

  /// Return the model of the vehicle.
  const ModelledVehicle& model() const { return model_; }

 private:
  Controller(const ControllerInfo& info, const VehicleDescription& vehicle, const Values& values,
             const std::vector<double>& spins);
  static Values complete_values(const std::string& name, const Values& values);
  void follow(double period, const Odometry& now, const Reference& wanted, const FlatState* flat,
              double* state, double* speeds) const;

  ModelledVehicle model_;
  Actuation actuation_;
  std::shared_ptr<const WrenchController> wrench_controller_;
  std::size_t memory_size_;  ///< state values of wrench_controller_
};

}  // namespace control
}  // namespace quadcore
