#pragma once

#include <cstdint>
#include <string>

#include "quadcore/plugin.hpp"
#include "quadcore/plugin/random.hpp"

namespace quadcore::rotors {

inline Vector3d vector_of(const Parameters& p, const std::string& tag) {
  return Vector3d(p.numbers(tag).data());
}

/// Return a uniform number between -bound and bound.
inline double uniform_within(double bound, std::uint64_t seed, double& draws) {
  if (bound == 0) return 0;
  const std::uint64_t bits = random_bits(seed, count_of(draws));
  draws += 1;
  return bound * (static_cast<double>(bits >> 11) / 4503599627370496.0 - 1);  // 2^52
}

/// Return a normal number with a standard deviation.
inline double normal_of(double deviation, std::uint64_t seed, double& draws) {
  return deviation == 0 ? 0 : deviation * random_normal(seed, draws);
}

/// Normal plus uniform noise on three numbers.
struct Noise {
  Vector3d normal, uniform;  ///< standard deviation, and bound

  Noise(const Parameters& p, const std::string& of)
      : normal(vector_of(p, "noiseNormal" + of)), uniform(vector_of(p, "noiseUniform" + of)) {}

  Vector3d draw(std::uint64_t seed, double& draws) const {
    Vector3d error;
    for (int i = 0; i < 3; ++i) {
      error[i] = normal_of(normal[i], seed, draws) + uniform_within(uniform[i], seed, draws);
    }
    return error;
  }
  double variance() const { return normal.cwiseAbs2().maxCoeff(); }
};

}  // namespace quadcore::rotors
