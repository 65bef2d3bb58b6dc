#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "quadcore/control/controller.hpp"
#include "quadcore/control/reference.hpp"
#include "quadcore/control/reference_preview.hpp"
#include "quadcore/control/rotor_health.hpp"
#include "quadcore/control/single_lane.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// A controller outside the vehicle that it flies: reads the odometry and the health of the rotors
/// from topics, and follows a reference.
class GuidedController {
 public:
  /// \param flown  description of the simulation's vehicle
  /// The simulation must outlive this.
  GuidedController(const Simulation& simulation, Controller controller,
                   const VehicleDescription& flown);

  /// Index of a topic that holds odometry. Throws InputError if it does not.
  static std::size_t find_odometry(const Topics& topics, const std::string& name);

  /// Reads the topics and writes the speeds to command, (rotors(),) signed [rad/s].
  /// \param period      time since the last call and until the next [s]
  /// \param odometry    index of the topic that holds the measured state
  /// \param list_times  lists the expected times of the next calls
  void command(double period, std::size_t odometry, const ReferenceShape& reference,
               const ReferencePreview::ListTimes& list_times, double* speeds);
  /// The same for a state and a reference of the caller.
  void command(double period, const Odometry& now, const Reference& wanted, double* speeds);

  /// Return the controller without its memory.
  const Controller& controller() const { return controller_; }
  /// How many rotors it drives.
  std::size_t rotors() const { return controller_.rotors(); }
  /// Whether the rotors could not exert what the last call asked for.
  bool saturated() const { return Controller::saturated(state_.data()); }

 private:
  void hear_of_health();

  const Simulation& simulation_;
  Controller controller_;
  ReferencePreview preview_;
  SingleLane single_lane_;
  RotorHealth health_of_;
  int health_;  ///< topic; -1: no plugin publishes it
  std::vector<double> state_;
};

}  // namespace control
}  // namespace quadcore
