#pragma once

#include "pack.hpp"

namespace quadcore::laws {

/// A vector with numbers or packs as components. As everywhere, its name contains the frame of its
/// components.
template <class T>
struct Vec3 {
  T x, y, z;

  Vec3() = default;
  QUADCORE_LAW Vec3(T of_x, T of_y, T of_z) : x(of_x), y(of_y), z(of_z) {}
  // Written out, because GCC would move packs through general registers.
  QUADCORE_LAW Vec3(const Vec3& a) : x(a.x), y(a.y), z(a.z) {}
  QUADCORE_LAW Vec3& operator=(const Vec3& a) {
    x = a.x;
    y = a.y;
    z = a.z;
    return *this;
  }
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
  return a.x * b.x + (a.y * b.y + a.z * b.z);  // in Eigen's order, for bit-identical results
}
template <class T>
QUADCORE_LAW Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

QUADCORE_LAW Vec3<double> vec(const double* a) { return {a[0], a[1], a[2]}; }

/// Return one vector for every lane.
template <class T>
QUADCORE_LAW Vec3<T> broadcast(const Vec3<double>& a) {
  return {broadcast<T>(a.x), broadcast<T>(a.y), broadcast<T>(a.z)};
}
template <class T>
QUADCORE_LAW Vec3<T> broadcast(const double* a) {
  return broadcast<T>(vec(a));
}

/// A matrix stored by rows.
template <class T>
struct Matrix3 {
  T xx, xy, xz, yx, yy, yz, zx, zy, zz;
};

QUADCORE_LAW Matrix3<double> matrix(const double* by_columns) {
  const double* m = by_columns;
  return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]};
}

template <class T>
QUADCORE_LAW Vec3<T> operator*(const Matrix3<T>& R, const Vec3<T>& a) {
  return {R.xx * a.x + (R.xy * a.y + R.xz * a.z), R.yx * a.x + (R.yy * a.y + R.yz * a.z),
          R.zx * a.x + (R.zy * a.y + R.zz * a.z)};
}

/// Return the transpose of a matrix times a vector: the inverse rotation.
template <class T>
QUADCORE_LAW Vec3<T> inversely(const Matrix3<T>& R, const Vec3<T>& a) {
  return {R.xx * a.x + (R.yx * a.y + R.zx * a.z), R.xy * a.x + (R.yy * a.y + R.zy * a.z),
          R.xz * a.x + (R.yz * a.y + R.zz * a.z)};
}

/// A symmetric matrix.
template <class T>
struct Symmetric3 {
  T xx, xy, xz, yy, yz, zz;
};

template <class T>
QUADCORE_LAW Vec3<T> operator*(const Symmetric3<T>& M, const Vec3<T>& a) {
  return {M.xx * a.x + (M.xy * a.y + M.xz * a.z), M.xy * a.x + (M.yy * a.y + M.yz * a.z),
          M.xz * a.x + (M.yz * a.y + M.zz * a.z)};
}

}  // namespace quadcore::laws
