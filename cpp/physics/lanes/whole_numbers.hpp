#pragma once

#include "pack.hpp"

/// \file
/// Packs of whole numbers, and rounding to them.

namespace quadcore::laws {

template <class T>
struct UnsignedLike {
  typedef std::uint64_t Pack __attribute__((vector_size(sizeof(T))));
};
template <>
struct UnsignedLike<double> {
  using Pack = std::uint64_t;
};

/// Unsigned integers with the size of a pack.
template <class T>
using UnsignedOf = typename UnsignedLike<T>::Pack;

/// Return the numbers with these bits.
template <class T>
QUADCORE_LAW T from_unsigned(UnsignedOf<T> pattern) {
  if constexpr (sizeof(T) == sizeof(double)) {
    T result;
    __builtin_memcpy(&result, &pattern, sizeof result);
    return result;
  } else {
    return reinterpret_cast<T>(pattern);
  }
}

/// Return the greatest whole number that is not above each lane.
template <class T>
QUADCORE_LAW T floor(T a) {
  if constexpr (lanes_of<T> == 1) {
    return __builtin_floor(a);
#ifdef __AVX__
  } else if constexpr (lanes_of<T> == 4) {
    return _mm256_floor_pd(a);
#endif
#ifdef __AVX512F__
  } else if constexpr (lanes_of<T> == 8) {
    return _mm512_floor_pd(a);
#endif
  } else {
    for (int i = 0; i < lanes_of<T>; ++i) a[i] = __builtin_floor(a[i]);
    return a;
  }
}

}  // namespace quadcore::laws
