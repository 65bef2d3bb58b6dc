#pragma once

#include "pack.hpp"
#include "quadcore/rotor_layout.hpp"

namespace quadcore::laws {

/// A vector whose components are numbers or packs of them. Which frame it is expressed in stands in
/// its name, as everywhere.
template <class T>
struct Vec3 {
  T x, y, z;
};

template <class T>
QUADCORE_LAW Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
QUADCORE_LAW Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T, class S>
QUADCORE_LAW Vec3<T> operator*(S factor, const Vec3<T>& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}
template <class T>
QUADCORE_LAW T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + (a.y * b.y + a.z * b.z);  // in Eigen's order, for the same bytes
}
template <class T>
QUADCORE_LAW Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// One vector for every lane.
template <class T>
QUADCORE_LAW Vec3<T> broadcast(const Vec3<double>& a) {
  return {broadcast<T>(a.x), broadcast<T>(a.y), broadcast<T>(a.z)};
}

/// A vector of each lane from three rows of a table.
template <class T>
QUADCORE_LAW Vec3<T> load3(const double* row) {
  return {load<T>(row), load<T>(row + widest_lanes), load<T>(row + 2 * widest_lanes)};
}
template <class T>
QUADCORE_LAW void store3(double* row, const Vec3<T>& a) {
  store(row, a.x);
  store(row + widest_lanes, a.y);
  store(row + 2 * widest_lanes, a.z);
}

/// A matrix, row by row.
template <class T>
struct Matrix3 {
  T xx, xy, xz, yx, yy, yz, zx, zy, zz;
};

/// Of a unit quaternion.
template <class T>
QUADCORE_LAW Matrix3<T> rotation(T x, T y, T z, T w) {
  const T x2 = x + x, y2 = y + y, z2 = z + z;
  const T xx = x * x2, yy = y * y2, zz = z * z2, xy = x * y2, xz = x * z2, yz = y * z2;
  const T wx = w * x2, wy = w * y2, wz = w * z2;
  return {1 - (yy + zz), xy - wz, xz + wy, xy + wz,      1 - (xx + zz),
          yz - wx,       xz - wy, yz + wx, 1 - (xx + yy)};
}
template <class T>
QUADCORE_LAW Vec3<T> operator*(const Matrix3<T>& R, const Vec3<T>& a) {
  return {R.xx * a.x + (R.xy * a.y + R.xz * a.z), R.yx * a.x + (R.yy * a.y + R.yz * a.z),
          R.zx * a.x + (R.zy * a.y + R.zz * a.z)};
}
template <class T>
QUADCORE_LAW Vec3<T> transposed_times(const Matrix3<T>& R, const Vec3<T>& a) {
  return {R.xx * a.x + (R.yx * a.y + R.zx * a.z), R.xy * a.x + (R.yy * a.y + R.zy * a.z),
          R.xz * a.x + (R.yz * a.y + R.zz * a.z)};
}

}  // namespace quadcore::laws
