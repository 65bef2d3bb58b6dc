#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "quadcore/plugin.hpp"

namespace quadcore::downwash {

/// Mean flow below a hovering quadrotor as a turbulent jet (Bauersfeld, Muller, Ziegler, Coletti,
/// Scaramuzza, "Robotics meets Fluid Dynamics: A Characterization of the Induced Airflow below a
/// Quadrotor as a Turbulent Jet", IEEE RA-L, 2025, arXiv:2403.13321). It holds from 2.5 l below the
/// rotors, where l is the distance of opposite rotors. Nearer, the flow is that at 2.5 l, and
/// within l it grows from zero at the height of the rotors, so that it has no step. Above the
/// rotors, the air is still.
struct TurbulentJet {
  static constexpr double decay = 10.11;            ///< B_d, eq. (9)
  static constexpr double spreading = 0.07668;      ///< S, eq. (9)
  static constexpr double virtual_origin = -5.817;  ///< s_0 / l, eq. (9)
  static constexpr double developed = 2.5;          ///< minimum distance below the rotors, in l

  Vector3d origin_W;     ///< centre of the rotors [m]
  Vector3d direction_W;  ///< unit vector against the force on the rotors
  double hover_speed;    ///< induced velocity of the rotors in hover, U_H [m/s]
  double length;         ///< l [m]

  /// Return the jet of a vehicle's rotors of known radius; none without such rotors or without
  /// thrust.
  /// \param density  of the air [kg/m^3]
  static std::optional<TurbulentJet> below(const OtherVehicle& vehicle, double density) {
    Vector3d sum_W = Vector3d::Zero(), force_W = Vector3d::Zero();
    double rotors = 0, area = 0, square = 0;
    for (const OtherRotor& rotor : vehicle.rotors) {
      if (std::isnan(rotor.radius)) continue;
      sum_W += rotor.p_WRcm_W;
      force_W += rotor.f_W;
      rotors += 1;
      area += M_PI * rotor.radius * rotor.radius;
      for (const OtherRotor& other : vehicle.rotors) {
        if (&other == &rotor) break;
        if (std::isnan(other.radius)) continue;
        square = std::max(square, (rotor.p_WRcm_W - other.p_WRcm_W).squaredNorm());
      }
    }
    const double thrust = force_W.norm();
    if (!(thrust > 0 && square > 0)) return std::nullopt;
    return TurbulentJet{sum_W / rotors, -force_W / thrust,
                        std::sqrt(thrust / (2 * density * area)),  // eq. (1)
                        std::sqrt(square)};
  }

  /// Return the distance of a point below the rotors, along the jet, in l.
  double depth(const Vector3d& p_W) const { return (p_W - origin_W).dot(direction_W) / length; }

  /// Return the velocity of the air at a point [m/s].
  Vector3d velocity_at(const Vector3d& p_W) const {
    const double s = depth(p_W);
    if (!(s > 0)) return Vector3d::Zero();
    const double r = (p_W - origin_W - s * length * direction_W).norm() / length;
    const double beyond = std::max(s, developed) - virtual_origin;
    const double center = hover_speed * decay / beyond;               // eq. (2)
    const double ratio = r / (spreading * beyond);                    // eqs. (4), (6)
    const double profile = 1 + (std::sqrt(2.0) - 1) * ratio * ratio;  // eq. (3)
    return std::min(s, 1.0) * center / (profile * profile) * direction_W;
  }
};

}  // namespace quadcore::downwash
