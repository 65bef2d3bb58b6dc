#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "quadcore/control/schedule.hpp"
#include "quadcore/flight.hpp"
#include "quadcore/plugin/export.hpp"
#include "quadcore/total_variation.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Advances a flight under a controller: calls it at its rate, and commands the rotors after its
/// delay.
class ControlLoop {
 public:
  /// Writes the rotor speeds to command until the next call, signed [rad/s].
  /// \param period  time since the last call and until the next [s]
  using Call = std::function<void(double period, double* speeds)>;

  /// \param simulation  what the flight advances; it must outlive the loop, and so must the flight
  /// \param rate        calls per simulated second, at most one per step
  /// \param delay       from a call to the first step that it commands [s]; the first call of the
  ///                    loop commands at once
  ControlLoop(Simulation& simulation, Flight& flight, double rate, double delay);

  /// Advances n steps. Throws what the flight, a command and the controller throw.
  void advance(std::int64_t n, const Call& call);

  /// \name Parts of advance(), for vehicles that a Fleet advances
  /// @{

  /// Call the controller and command the rotors if that is due. Returns the number of steps, at
  /// most n, until the next event.
  std::int64_t prepare(std::int64_t n, const Call& call);
  /// Take note of a step after prepare().
  void finish();
  /// @}

  /// Return the total variation of the magnitude of each rotor's joint rate over all steps so far
  /// [rad/s].
  const std::vector<double>& rate_variation() const { return rates_.sums(); }
  /// Return the total variation of the magnitude of each command over all steps so far [rad/s].
  const std::vector<double>& command_variation() const { return commands_.sums(); }
  /// Write the times of the present call and of the next ones if the flight goes on [s].
  void list_times(double* times, std::size_t count) const;

 private:
  Simulation& simulation_;
  Flight& flight_;
  std::size_t width_;  ///< numbers of a command
  Schedule schedule_;
  std::vector<double> state_;
  double step_ = 0;  ///< since the loop began
  TotalVariation rates_, commands_;
};

}  // namespace control
}  // namespace quadcore
