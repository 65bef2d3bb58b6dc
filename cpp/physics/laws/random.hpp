#pragma once

#include "lanes/logarithm.hpp"
#include "lanes/vec3.hpp"
#include "lanes/whole_numbers.hpp"
#include "laws/angles.hpp"

/// \file
/// Reproducible random numbers for packs, bit-identical to those of quadcore/plugin/random.hpp.

namespace quadcore::laws {

/// Return number `count` of the stream `seed` by SplitMix64 (Steele, Lea, Flood, OOPSLA 2014).
template <class T>
QUADCORE_LAW UnsignedOf<T> random_bits(UnsignedOf<T> seed, UnsignedOf<T> count) {
  UnsignedOf<T> z = seed + (count + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

/// Return the fraction between 0 and 1 of random bits.
template <class T>
QUADCORE_LAW T random_fraction(UnsignedOf<T> random) {
  constexpr double two_to_52 = 4503599627370496.0, two_to_84 = 19342813113834066795298816.0;
  const UnsignedOf<T> whole = random >> 11;
  // Whole numbers of 32 and 21 bits as the last bits of 2^52 and 2^84.
  const UnsignedOf<T> last = (whole & 0xFFFFFFFFULL) | 0x4330000000000000ULL;
  const UnsignedOf<T> first = (whole >> 32) | 0x4530000000000000ULL;
  const T low = from_unsigned<T>(last) - two_to_52, high = from_unsigned<T>(first) - two_to_84;
  return ((high + low) + 0.5) * (1.0 / 9007199254740992.0);  // 2^-53
}

/// Return a standard normal number by Box and Muller. Advances `count` by two.
template <class T>
QUADCORE_LAW T random_normal(UnsignedOf<T> seed, UnsignedOf<T>& count) {
  const T u = random_fraction<T>(random_bits<T>(seed, count));
  const T v = random_fraction<T>(random_bits<T>(seed, count + 1));
  count += 2;
  return square_root(-2 * logarithm(u)) * sine_and_cosine(6.283185307179586 * v).cos;
}

/// Return a vector of standard normal numbers.
template <class T>
QUADCORE_LAW Vec3<T> random_vector(UnsignedOf<T> seed, UnsignedOf<T>& count) {
  const T x = random_normal<T>(seed, count), y = random_normal<T>(seed, count),
          z = random_normal<T>(seed, count);
  return {x, y, z};
}

}  // namespace quadcore::laws
