#pragma once

#include <cstdint>
#ifdef __SSE2__
#include <immintrin.h>
#endif

/// \file
/// Packs of numbers, so that a force law is written only once. A pack contains W doubles of W
/// rotors (or vehicles), and +, -, *, / and sqrt act on each separately with IEEE 754 rounding. The
/// results are bit-identical for all W, because no operation mixes the numbers of a pack. Files
/// compiled for a specific processor may include this, but neither Eigen nor standard library
/// headers with code. The linker would keep only one copy of such code, possibly one that other
/// processors cannot run.

#define QUADCORE_INLINED __attribute__((always_inline))
#define QUADCORE_LAW inline QUADCORE_INLINED

namespace quadcore::laws {

template <int W>
struct PackOf;
template <>
struct PackOf<1> {
  using Numbers = double;
  using Bits = std::int64_t;
  using InMemory = double;
};
// Defined individually: GCC 10 loses the alignment of an InMemory with a size parameter.
#define QUADCORE_PACK_OF(width)                                                             \
  template <>                                                                               \
  struct PackOf<width> {                                                                    \
    typedef double Numbers __attribute__((vector_size(8 * width)));                         \
    typedef std::int64_t Bits __attribute__((vector_size(8 * width)));                      \
    typedef double InMemory __attribute__((vector_size(8 * width), aligned(8), may_alias)); \
  };
QUADCORE_PACK_OF(2)
QUADCORE_PACK_OF(4)
QUADCORE_PACK_OF(8)
#undef QUADCORE_PACK_OF

/// W doubles; one is a plain double.
template <int W>
using Pack = typename PackOf<W>::Numbers;

/// Integers with the size of a pack.
template <class T>
using BitsOf = typename PackOf<sizeof(T) / sizeof(double)>::Bits;

template <class T>
using InMemory = typename PackOf<sizeof(T) / sizeof(double)>::InMemory;

template <class T>
QUADCORE_LAW T load(const double* from) {
  return *reinterpret_cast<const InMemory<T>*>(from);
}

template <class T>
QUADCORE_LAW void store(double* to, T pack) {
  *reinterpret_cast<InMemory<T>*>(to) = pack;
}

template <class T>
QUADCORE_LAW T broadcast(double number) {
  // An exact operation with a pack, because GCC would insert the numbers lane by lane.
  return number - T{};
}

template <class T>
QUADCORE_LAW BitsOf<T> bits(T pack) {
  if constexpr (sizeof(T) == sizeof(double)) {
    BitsOf<T> result;
    __builtin_memcpy(&result, &pack, sizeof result);
    return result;
  } else {
    return reinterpret_cast<BitsOf<T>>(pack);
  }
}

template <class T>
QUADCORE_LAW T from_bits(BitsOf<T> pattern) {
  if constexpr (sizeof(T) == sizeof(double)) {
    T result;
    __builtin_memcpy(&result, &pattern, sizeof result);
    return result;
  } else {
    return reinterpret_cast<T>(pattern);
  }
}

/// Consecutive integers with the size of a pack.
template <class T>
QUADCORE_LAW BitsOf<T> load_bits(const std::int64_t* from) {
  BitsOf<T> pack;
  __builtin_memcpy(&pack, from, sizeof pack);
  return pack;
}
template <class T>
QUADCORE_LAW void store_bits(std::int64_t* to, BitsOf<T> pack) {
  __builtin_memcpy(to, &pack, sizeof pack);
}

template <class T>
constexpr int lanes_of = sizeof(T) / sizeof(double);

/// Return whether a comparison of packs is true in any lane.
template <class Mask>
QUADCORE_LAW bool any(const Mask& mask) {
  if constexpr (sizeof(Mask) <= sizeof(std::int64_t)) {
    return mask != 0;
#ifdef __AVX__
  } else if constexpr (sizeof(Mask) == sizeof(__m256i)) {
    return !_mm256_testz_si256((__m256i)mask, (__m256i)mask);
#endif
#ifdef __AVX512F__
  } else if constexpr (sizeof(Mask) == sizeof(__m512i)) {
    return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0;
#endif
  } else {
    std::int64_t of_any = 0;
    for (unsigned i = 0; i < sizeof(Mask) / sizeof(std::int64_t); ++i) of_any |= mask[i];
    return of_any != 0;
  }
}

constexpr std::int64_t sign_bit = INT64_MIN;

template <class T>
QUADCORE_LAW T absolute(T a) {
  return from_bits<T>(bits(a) & ~sign_bit);
}

/// Return the square root of each lane with IEEE 754 rounding.
template <class T>
QUADCORE_LAW T square_root(T a) {
  if constexpr (lanes_of<T> == 1) {
    return __builtin_sqrt(a);
#ifdef __SSE2__
  } else if constexpr (lanes_of<T> == 2) {
    return _mm_sqrt_pd(a);
#endif
#ifdef __AVX__
  } else if constexpr (lanes_of<T> == 4) {
    return _mm256_sqrt_pd(a);
#endif
#ifdef __AVX512F__
  } else if constexpr (lanes_of<T> == 8) {
    return _mm512_maskz_sqrt_pd(0xFF, a);
#endif
  } else {
    for (int i = 0; i < lanes_of<T>; ++i) a[i] = __builtin_sqrt(a[i]);
    return a;
  }
}

/// Return a where a comparison of packs is true, else b.
template <class Mask, class T>
QUADCORE_LAW T chosen_by(const Mask& mask, T a, T b) {
  if constexpr (lanes_of<T> == 1) {
    return mask ? a : b;
  } else {
    return from_bits<T>((bits(a) & mask) | (bits(b) & ~mask));
  }
}

/// Test the bits, because compiler options may assume that all numbers are finite.
template <class T>
QUADCORE_LAW auto is_finite(T a) {
  constexpr std::int64_t exponent = 0x7FF0000000000000;
  return (bits(a) & exponent) != exponent;
}

/// Return |a| with the sign of b.
template <class T>
QUADCORE_LAW T with_sign_of(T b, T a) {
  return from_bits<T>((bits(a) & ~sign_bit) | (bits(b) & sign_bit));
}

}  // namespace quadcore::laws
