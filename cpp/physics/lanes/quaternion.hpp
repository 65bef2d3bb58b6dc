#pragma once

#include "vec3.hpp"

namespace quadcore::laws {

/// A quaternion, or its rate.
template <class T>
struct Quaternion {
  T x, y, z, w;
};

/// Return Hamilton's product: the rotation b, then a.
template <class T>
QUADCORE_LAW Quaternion<T> operator*(const Quaternion<T>& a, const Quaternion<T>& b) {
  return {a.w * b.x + a.x * b.w + (a.y * b.z - a.z * b.y),
          a.w * b.y + a.y * b.w + (a.z * b.x - a.x * b.z),
          a.w * b.z + a.z * b.w + (a.x * b.y - a.y * b.x),
          a.w * b.w - (a.x * b.x + a.y * b.y + a.z * b.z)};
}

/// Return the rotation matrix of a unit quaternion.
template <class T>
QUADCORE_LAW Matrix3<T> rotation(const Quaternion<T>& q) {
  const T x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
  const T xx = x2 * q.x, yy = y2 * q.y, zz = z2 * q.z;
  const T xy = x2 * q.y, yz = y2 * q.z, zx = z2 * q.x;
  const T wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
  return {1 - (yy + zz), xy - wz, zx + wy, xy + wz,      1 - (zz + xx),
          yz - wx,       zx - wy, yz + wx, 1 - (xx + yy)};
}

}  // namespace quadcore::laws
