#pragma once

#include <cstddef>

#include "controller_numbers.hpp"

/// \file
/// Modelled rotors as formulas for numbers or packs, see Actuation. Contains neither Eigen nor
/// code, so that files compiled for a specific processor can include it.

namespace quadcore::control {

/// Rows of the state of Actuation: whether it has begun, whether the last demand was not met, the
/// period of the following fractions, the wanted fraction of a change within it; then the modelled
/// rotor speeds (without sign), the lost fractions, and the fraction of a change of each rotor.
struct ActuationRow {
  enum : std::size_t { begun, saturated, period, wanted_share, speeds };

  static constexpr std::size_t lost(std::size_t rotors) { return speeds + rotors; }
  static constexpr std::size_t shares(std::size_t rotors) { return speeds + 2 * rotors; }
  static constexpr std::size_t count(std::size_t rotors) { return speeds + 3 * rotors; }
};

/// The part of a rotor in thrust and torques.
template <class T>
struct AllocatedRotor {
  T least, most;  ///< bounds of the squared speed
  T inverse[4];   ///< squared speed per thrust and torques
  T effect[4];    ///< thrust and torques per squared speed
};

/// A modelled rotor, see ModelledRotor.
template <class T>
struct RotorNumbers {
  Vec3<T> h_F;  ///< angular momentum per unit of speed
  T spin;
  T lags;   ///< 1 with a lag, else 0
  T leads;  ///< 1 with a compensated lag, else 0
  T slowest, fastest;
  AllocatedRotor<T> allocated;
};

/// Add the wrench of a rotor.
/// \param left  remaining fraction of its thrust and torque
template <class T>
QUADCORE_LAW void add_wrench(const AllocatedRotor<T>& rotor, T square, T left,
                             DemandNumbers<T>& sum) {
  const T share = left * square;
  sum.thrust = sum.thrust + share * rotor.effect[0];
  sum.torque_F = sum.torque_F + share * Vec3<T>{rotor.effect[1], rotor.effect[2], rotor.effect[3]};
}

/// Add the angular momentum of a rotor.
template <class T>
QUADCORE_LAW void add_momentum(const RotorNumbers<T>& rotor, T speed, Vec3<T>& sum_F) {
  sum_F = sum_F + speed * rotor.h_F;
}

/// Return the squared speed for a demand without limits: the one with the minimum sum of squares.
template <class T>
QUADCORE_LAW T square_for(const AllocatedRotor<T>& rotor, const DemandNumbers<T>& demand) {
  const Vec3<T>& torque_F = demand.torque_F;
  return (torque_F.x * rotor.inverse[1] + torque_F.y * rotor.inverse[2]) +
         (torque_F.z * rotor.inverse[3] + demand.thrust * rotor.inverse[0]);
}

/// Return whether a squared speed is within the limits of a rotor.
template <class T>
QUADCORE_LAW auto is_allowed(const AllocatedRotor<T>& rotor, T square, T left) {
  return (square >= left * rotor.least) & (square <= left * rotor.most);
}

/// A command and the modelled speed at the next call.
template <class T>
struct LedNumbers {
  T command, modelled;
  T excess;  ///< difference between the command and the one without limits
};

/// Maximum LedNumbers::excess of a command that counts as within the limits [rad/s].
constexpr double largest_excess = 1e-6;

/// Return the command for a wanted speed. A rotor approaches a command with its lag tau, dw/dt =
/// (command - w)/tau; a compensating command makes it approach the wanted speed with lead_time.
/// \param wanted_share, share  fraction of a change within the period: the wanted one, and that of
///                             the rotor
template <class T>
QUADCORE_LAW LedNumbers<T> lead(const RotorNumbers<T>& rotor, T wanted, T modelled, T wanted_share,
                                T share) {
  const T ahead = modelled + wanted_share / share * (wanted - modelled);
  const T below = laws::chosen_by(rotor.fastest < ahead, rotor.fastest, ahead);
  const T within = laws::chosen_by(ahead < rotor.slowest, rotor.slowest, below);
  const auto leads = rotor.leads > 0;
  const T command = laws::chosen_by(leads, within, wanted);
  const T next = modelled + share * (command - modelled);
  return {command, laws::chosen_by(rotor.lags > 0, next, wanted),
          laws::chosen_by(leads, laws::absolute(within - ahead), T{})};
}

}  // namespace quadcore::control
