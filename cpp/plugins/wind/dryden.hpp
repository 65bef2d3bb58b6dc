#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/random.hpp"
#include "quadcore/plugin/spatial.hpp"

/// \file
/// Turbulence with Dryden spectra, MIL-F-8785C, low altitude (3.7.2.2, 3.7.3). The discretisation
/// is exact: for any time step, the samples have the covariance of the continuous process. It
/// consists of plain numbers, which can be part of a plugin's state.

namespace quadcore::wind {

/// Scale lengths [m] and standard deviations [m/s] of the gusts along (and across) the mean wind
/// and of the vertical gusts.
struct DrydenScales {
  double length_uv, length_w, sigma_uv, sigma_w;
};

/// \param height  above the ground, 10 ft to 1000 ft [m]
/// \param W20     wind at 20 ft [m/s]
inline DrydenScales low_altitude(double height, double W20) {
  const double feet = height / 0.3048;
  const double log_term = elementary::log(0.177 + 0.000823 * feet);
  const double sigma_w = 0.1 * W20;
  return {height / elementary::exp(1.2 * log_term), height,
          sigma_w / elementary::exp(0.4 * log_term), sigma_w};
}

/// Phi_u = sigma^2 2L/(pi V) / (1 + (L w/V)^2): white noise through a lag, with unit variance.
struct LongitudinalFilter {
  double decay, kick, x;

  static LongitudinalFilter of(double length, double airspeed, double dt) {
    const double decay = elementary::exp(-airspeed / length * dt);
    return {decay, std::sqrt(1 - decay * decay), 0};
  }
  void settle(double noise) { x = noise; }
  double advance(double noise) { return x = decay * x + kick * noise; }
};

/// Phi_v,w = sigma^2 L/(pi V) (1 + 3 (L w/V)^2) / (1 + (L w/V)^2)^2, of unit variance: with a = V/L
/// and white noise n, x' = -a x + sqrt(a) n, y' = -a y + a x, and sqrt(3) x + (1 - sqrt(3)) y is
/// the output. The stationary covariance of x, y is 1/2, 1/4, 1/4.
struct TransverseFilter {
  double decay, carry;  ///< factors over a step
  double xx, xy, yy;    ///< lower triangle that maps white noise to the noise of a step
  double x, y;

  static TransverseFilter of(double length, double airspeed, double dt) {
    const double d = airspeed / length * dt, decay = elementary::exp(-d);
    // The step's noise has the covariance E S1/2, E S2/4, E S3/4 with E = exp(-z) and Sn = z^n/n! +
    // z^(n+1)/(n+1)! + ..., z = 2d: this form loses no digits at small steps.
    const double z = std::min(2 * d, 300.0), E = elementary::exp(-z);
    double term = 1, S3 = 0;
    for (int n = 1; n < 3 || term > 1e-17 * S3; ++n) {
      term *= z / n;
      if (n >= 3) S3 += term;
    }
    const double S2 = S3 + z * z / 2, S1 = S2 + z;
    const double xx = std::sqrt(E * S1 / 2), xy = E * S2 / 4 / xx;
    return {decay, decay * d, xx, xy, std::sqrt(E * (2 * S1 * S3 - S2 * S2) / (8 * S1)), 0, 0};
  }
  void settle(double noise_x, double noise_y) {
    x = noise_x * std::sqrt(0.5);
    y = (x + noise_y * std::sqrt(0.5)) / 2;
  }
  void advance(double noise_x, double noise_y) {
    y = decay * y + carry * x + xy * noise_x + yy * noise_y;
    x = decay * x + xx * noise_x;
  }
  double out() const { return std::sqrt(3.0) * x + (1 - std::sqrt(3.0)) * y; }
};

/// The turbulence of a flight: the state of its filters, which use a constant airspeed, and the
/// direction of u.
struct Turbulence {
  double draws, begun;
  double along_x, along_y;  ///< unit: u in the world; v is to its left, w up
  LongitudinalFilter u;
  TransverseFilter v, w;

  /// Initialise the turbulence from the stationary process.
  /// \param v_VA_W  mean wind relative to the vehicle [m/s]
  /// \param airspeed  minimum airspeed [m/s]
  void begin(const DrydenScales& scales, const Vector3d& v_VA_W, double airspeed, double dt,
             std::uint64_t seed) {
    const double level = std::sqrt(v_VA_W.x() * v_VA_W.x() + v_VA_W.y() * v_VA_W.y());
    along_x = level > 0 ? v_VA_W.x() / level : 1;
    along_y = level > 0 ? v_VA_W.y() / level : 0;
    const double V = std::max(v_VA_W.norm(), airspeed);
    u = LongitudinalFilter::of(scales.length_uv, V, dt);
    v = TransverseFilter::of(scales.length_uv, V, dt);
    w = TransverseFilter::of(scales.length_w, V, dt);
    u.settle(draw(seed));
    for (TransverseFilter* filter : {&v, &w}) {
      const double noise_x = draw(seed);
      filter->settle(noise_x, draw(seed));
    }
    begun = 1;
  }

  void advance(std::uint64_t seed) {
    u.advance(draw(seed));
    for (TransverseFilter* filter : {&v, &w}) {
      const double noise_x = draw(seed);
      filter->advance(noise_x, draw(seed));
    }
  }

  Vector3d v_WA_W(const DrydenScales& scales) const {
    const double along = scales.sigma_uv * u.x, left = scales.sigma_uv * v.out();
    return {along_x * along - along_y * left, along_y * along + along_x * left,
            scales.sigma_w * w.out()};
  }

 private:
  double draw(std::uint64_t seed) { return random_normal(seed, draws); }
};

}  // namespace quadcore::wind
