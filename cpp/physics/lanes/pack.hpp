#pragma once

#include <cstdint>
#ifdef __SSE2__
#include <immintrin.h>
#endif

/// \file
/// Several numbers side by side, on which a law is written once: a pack holds W doubles of W rotors
/// (or vehicles), and +, -, *, / and sqrt act on each by itself, rounded as IEEE 754 asks. A law
/// gives the same bytes whatever W is, because nothing here mixes the numbers of a pack.
///
/// Files that are compiled for one processor include this and nothing of Eigen or the standard
/// library that has code in headers: the linker would keep one copy of such code for all files,
/// perhaps the one that most processors cannot run.

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
// Each by itself: of a size that is a parameter, GCC 10 forgets how an InMemory is aligned.
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

/// The whole numbers of a pack's size.
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
  if constexpr (sizeof(T) == sizeof(double)) {
    return number;
  } else {
    T pack;
    for (unsigned i = 0; i < sizeof(T) / sizeof(double); ++i) pack[i] = number;
    return pack;
  }
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

/// Whole numbers of a pack's size, one behind another.
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

/// Whether a comparison of packs holds in any lane.
template <class Mask>
QUADCORE_LAW bool any(const Mask& mask) {
  if constexpr (sizeof(Mask) <= sizeof(std::int64_t)) {
    return mask != 0;
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

/// Of each lane, rounded as IEEE 754 asks.
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

/// a where a comparison of packs holds, else b.
template <class Mask, class T>
QUADCORE_LAW T chosen_by(const Mask& mask, T a, T b) {
  if constexpr (lanes_of<T> == 1) {
    return mask ? a : b;
  } else {
    return from_bits<T>((bits(a) & mask) | (bits(b) & ~mask));
  }
}

/// Told by the bits, because the compiler may be told to take every number for finite.
QUADCORE_LAW bool is_finite(double a) {
  constexpr std::int64_t exponent = 0x7FF0000000000000;
  return (bits(a) & exponent) != exponent;
}

/// |a| with the sign of b.
template <class T>
QUADCORE_LAW T with_sign_of(T b, T a) {
  return from_bits<T>((bits(a) & ~sign_bit) | (bits(b) & sign_bit));
}

}  // namespace quadcore::laws
