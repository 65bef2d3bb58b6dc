#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "quadcore/control/schedule.hpp"
#include "quadcore/flight.hpp"
#include "quadcore/plugin/export.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// Sums the magnitudes of the changes of some numbers, their total variation.
class TotalVariation {
 public:
  void add(const Eigen::ArrayXd& values) {
    if (sums_.size() == 0) sums_ = Eigen::ArrayXd::Zero(values.size());
    if (last_.size() > 0) sums_ += (values - last_).abs();
    last_ = values;
  }
  const Eigen::ArrayXd& sums() const { return sums_; }

 private:
  Eigen::ArrayXd last_, sums_;
};

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

  /// Total variation of the magnitude of each rotor's joint rate over all steps so far [rad/s].
  const Eigen::ArrayXd& rate_variation() const { return rates_.sums(); }
  /// Total variation of the magnitude of each command over all steps so far [rad/s].
  const Eigen::ArrayXd& command_variation() const { return commands_.sums(); }

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
