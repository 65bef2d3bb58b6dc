#pragma once

#include "vec3.hpp"

namespace quadcore::laws {

/// Four numbers of the frame: a vector followed by 0, or a quaternion x, y, z, w. For narrower
/// lanes, the compiler splits it with bit-identical results.
using Four = Pack<4>;

/// Create from three adjacent numbers.
QUADCORE_LAW Four load_vector(const double* a) { return Four{a[0], a[1], a[2], 0}; }
/// Return four of the eight numbers of a and b.
template <int i, int j, int k, int l>
QUADCORE_LAW Four chosen(const Four& a, const Four& b) {
#ifdef __clang__
  return __builtin_shufflevector(a, b, i, j, k, l);
#else
  return __builtin_shuffle(a, b, BitsOf<Four>{i, j, k, l});
#endif
}
template <int i, int j, int k, int l>
QUADCORE_LAW Four permuted(const Four& a) {
  return chosen<i, j, k, l>(a, a);
}

/// Return the numbers with the signs inverted where the flag is 1.
template <int i, int j, int k, int l>
QUADCORE_LAW Four negated(const Four& a) {
  return from_bits<Four>(bits(a) ^
                         BitsOf<Four>{i * sign_bit, j * sign_bit, k * sign_bit, l * sign_bit});
}

QUADCORE_LAW Four cross(const Four& a, const Four& b) {
  return permuted<1, 2, 0, 3>(a * permuted<1, 2, 0, 3>(b) - permuted<1, 2, 0, 3>(a) * b);
}

QUADCORE_LAW Four first_three(const Four& a) {
  return from_bits<Four>(bits(a) & BitsOf<Four>{-1, -1, -1, 0});
}

/// Store a vector as a pair and a number, like Eigen reads it; numbers that are stored one by one
/// stall when they are read in pairs.
QUADCORE_LAW void store_vector(double* to, const Four& a) {
  store(to, Pack<2>{a[0], a[1]});
  to[2] = a[2];
}

/// Return the vector for every lane.
template <class T>
QUADCORE_LAW Vec3<T> broadcast(const Four& a) {
  if constexpr (lanes_of<T> == 4) {
    return {permuted<0, 0, 0, 0>(a), permuted<1, 1, 1, 1>(a), permuted<2, 2, 2, 2>(a)};
  } else {
    return {broadcast<T>(a[0]), broadcast<T>(a[1]), broadcast<T>(a[2])};
  }
}

/// A matrix stored by columns.
struct Columns {
  Four x, y, z;
};
QUADCORE_LAW Columns load_columns(const double (*m)[4]) {
  return {load<Four>(m[0]), load<Four>(m[1]), load<Four>(m[2])};
}
QUADCORE_LAW Four operator*(const Columns& M, const Four& a) {
  return M.x * permuted<0, 0, 0, 0>(a) +
         (M.y * permuted<1, 1, 1, 1>(a) + M.z * permuted<2, 2, 2, 2>(a));
}

/// A rotation and its inverse.
struct Rotation {
  Columns to, from;
};

/// Return the matrix with the diagonal d and off-diagonal s and r: (d0, s1, r2), (r0, d1, s2), (s0,
/// r1, d2).
QUADCORE_LAW Columns columns(const Four& d, const Four& s, const Four& r) {
  return {chosen<0, 1, 6, 3>(chosen<0, 5, 2, 3>(d, s), r),
          chosen<4, 1, 2, 3>(chosen<0, 1, 6, 3>(d, s), r),
          chosen<0, 5, 2, 3>(chosen<4, 1, 2, 3>(d, s), r)};
}

/// Return the rotation of a unit quaternion q = (u, w): 1 - 2 (u.u 1 - u u^T) + 2 w [u x], and the
/// inverse with -w.
QUADCORE_LAW Rotation rotation(const Four& q) {
  const Four next = permuted<1, 2, 0, 3>(q), after = permuted<2, 0, 1, 3>(q);
  const Four twice = q + q, next_twice = next + next, after_twice = after + after;
  const Four w = permuted<3, 3, 3, 3>(q);
  const Four by_next = twice * next, w_after = w * after_twice;
  const Four by_after = twice * after, w_next = w * next_twice;
  const Four diagonal = first_three(1 - (next_twice * next + after_twice * after));
  return {columns(diagonal, by_after + w_next, by_next - w_after),
          columns(diagonal, by_after - w_next, by_next + w_after)};
}

/// Add the lanes of four packs, the last first, to four sums that each fill a pack.
QUADCORE_LAW void add_lanes_backwards(Four& a, Four& b, Four& c, Four& d, const Four& to_a,
                                      const Four& to_b, const Four& to_c, const Four& to_d) {
  const Four ab_02 = chosen<0, 4, 2, 6>(to_a, to_b), ab_13 = chosen<1, 5, 3, 7>(to_a, to_b);
  const Four cd_02 = chosen<0, 4, 2, 6>(to_c, to_d), cd_13 = chosen<1, 5, 3, 7>(to_c, to_d);
  Four sum{a[0], b[0], c[0], d[0]};
  sum = sum + chosen<2, 3, 6, 7>(ab_13, cd_13);
  sum = sum + chosen<2, 3, 6, 7>(ab_02, cd_02);
  sum = sum + chosen<0, 1, 4, 5>(ab_13, cd_13);
  sum = sum + chosen<0, 1, 4, 5>(ab_02, cd_02);
  a = permuted<0, 0, 0, 0>(sum);
  b = permuted<1, 1, 1, 1>(sum);
  c = permuted<2, 2, 2, 2>(sum);
  d = permuted<3, 3, 3, 3>(sum);
}

/// Return sum plus the vectors of a pack of rotors, added in order.
template <class T>
QUADCORE_LAW void add_in_order(Four& sum, const Vec3<T>& of_rotors) {
  if constexpr (lanes_of<T> == 8) {
    const auto half = [&](int h) {
      double x[8], y[8], z[8];
      store(x, of_rotors.x);
      store(y, of_rotors.y);
      store(z, of_rotors.z);
      return Vec3<Four>{load<Four>(x + 4 * h), load<Four>(y + 4 * h), load<Four>(z + 4 * h)};
    };
    add_in_order(sum, half(0));
    add_in_order(sum, half(1));
  } else if constexpr (lanes_of<T> == 4) {
    const Four &x = of_rotors.x, &y = of_rotors.y, &z = of_rotors.z, none{};
    const Four xy_02 = chosen<0, 4, 2, 6>(x, y), xy_13 = chosen<1, 5, 3, 7>(x, y);
    const Four z_02 = chosen<0, 4, 2, 6>(z, none), z_13 = chosen<1, 5, 3, 7>(z, none);
    sum = sum + chosen<0, 1, 4, 5>(xy_02, z_02);
    sum = sum + chosen<0, 1, 4, 5>(xy_13, z_13);
    sum = sum + chosen<2, 3, 6, 7>(xy_02, z_02);
    sum = sum + chosen<2, 3, 6, 7>(xy_13, z_13);
  } else if constexpr (lanes_of<T> == 2) {
    sum = sum + Four{of_rotors.x[0], of_rotors.y[0], of_rotors.z[0], 0};
    sum = sum + Four{of_rotors.x[1], of_rotors.y[1], of_rotors.z[1], 0};
  } else {
    sum = sum + Four{of_rotors.x, of_rotors.y, of_rotors.z, 0};
  }
}

}  // namespace quadcore::laws
