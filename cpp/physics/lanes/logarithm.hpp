#pragma once

#include "pack.hpp"

namespace quadcore::laws {

/// ln 2 in two pieces. The first has 32 bits, so that a whole multiple is exact.
constexpr double ln2_high = 6.93147180369123816490e-01;
constexpr double ln2_low = 1.90821492927058770002e-10;

/// Return the natural logarithm of 2^exponent x for a positive normal number x, by the minimax
/// polynomial of fdlibm 5.3 (Sun Microsystems, 1993, e_log.c at netlib.org/fdlibm, which derives it
/// and bounds its error).
template <class T>
QUADCORE_LAW T logarithm(T x, double exponent = 0) {
  constexpr double to_whole = 6755399441055744.0;
  // x = 2^k (1 + f), sqrt(2)/2 < 1 + f < sqrt(2)
  const BitsOf<T> all = bits(x);
  const BitsOf<T> mantissa = all & 0xFFFFFFFFFFFFF;
  const BitsOf<T> upper = (0x6A09E667F3BCC - mantissa) >> 63;  // -1 above sqrt(2), else 0
  const BitsOf<T> power = (all >> 52) - (upper + 1023);
  const T k = (from_bits<T>(power + bits(to_whole)) - to_whole) + exponent;
  const T f = from_bits<T>(mantissa | (0x3FF0000000000000 - (upper & 0x0010000000000000))) - 1;
  const T s = f / (2 + f);
  const T z = s * s;
  const T w = z * z;
  const T R = z * (6.666666666666735130e-01 +
                   w * (2.857142874366239149e-01 +
                        w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01))) +
              w * (3.999999999940941908e-01 +
                   w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const T half_square = 0.5 * f * f;
  return k * ln2_high - ((half_square - (s * (half_square + R) + k * ln2_low)) - f);
}

}  // namespace quadcore::laws
