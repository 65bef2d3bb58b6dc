#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "quadcore/plugin/counts.hpp"
#include "quadcore/plugin/elementary.hpp"

/// \file
/// Reproducible random numbers: identical on every machine and standard library. Their state is a
/// plain count, which is part of a plugin's state.

namespace quadcore {

/// Return number `count` of the stream `seed` by SplitMix64 (Steele, Lea, Flood, OOPSLA 2014).
inline std::uint64_t random_bits(std::uint64_t seed, std::uint64_t count) {
  std::uint64_t z = seed + (count + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

/// Return a standard normal number by Box and Muller. Advances `count` (a whole number) by two.
inline double random_normal(std::uint64_t seed, double& count) {
  const std::uint64_t n = count_of(count);
  count += 2;
  const double scale = 1.0 / 9007199254740992.0;  // 2^-53
  const double u = (static_cast<double>(random_bits(seed, n) >> 11) + 0.5) * scale;
  const double v = (static_cast<double>(random_bits(seed, n + 1) >> 11) + 0.5) * scale;
  return std::sqrt(-2 * elementary::log(u)) * elementary::cos(6.283185307179586 * v);
}

/// Return the seed of a separate stream for each name under one seed (FNV-1a).
inline std::uint64_t stream_seed(std::uint64_t seed, const std::string& name) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
  return random_bits(seed, 0) ^ hash;
}

}  // namespace quadcore
