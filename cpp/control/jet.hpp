#pragma once

#include "lanes/vec3.hpp"

namespace quadcore::control {

using laws::Vec3;

/// A vector and its first two time derivatives.
template <class T>
struct Jet {
  Vec3<T> x, dx, ddx;
};

/// A number and its first two time derivatives.
template <class T>
struct ScalarJet {
  T x, dx, ddx;
};

template <class T>
QUADCORE_LAW Jet<T> operator+(const Jet<T>& a, const Jet<T>& b) {
  return {a.x + b.x, a.dx + b.dx, a.ddx + b.ddx};
}
template <class T>
QUADCORE_LAW Jet<T> operator*(double factor, const Jet<T>& a) {
  return {factor * a.x, factor * a.dx, factor * a.ddx};
}
template <class T>
QUADCORE_LAW Jet<T> operator*(const ScalarJet<T>& s, const Jet<T>& a) {
  return {s.x * a.x, s.dx * a.x + s.x * a.dx, s.ddx * a.x + (2 * s.dx) * a.dx + s.x * a.ddx};
}
template <class T>
QUADCORE_LAW Jet<T> cross(const Jet<T>& a, const Jet<T>& b) {
  return {cross(a.x, b.x), cross(a.dx, b.x) + cross(a.x, b.dx),
          cross(a.ddx, b.x) + 2.0 * cross(a.dx, b.dx) + cross(a.x, b.ddx)};
}
template <class T>
QUADCORE_LAW ScalarJet<T> dot(const Jet<T>& a, const Jet<T>& b) {
  return {dot(a.x, b.x), dot(a.dx, b.x) + dot(a.x, b.dx),
          dot(a.ddx, b.x) + 2 * dot(a.dx, b.dx) + dot(a.x, b.ddx)};
}
/// Return the square root of a positive number.
template <class T>
QUADCORE_LAW ScalarJet<T> sqrt(const ScalarJet<T>& s) {
  const T root = laws::square_root(s.x), d_root = s.dx / (2 * root);
  return {root, d_root, (s.ddx / 2 - d_root * d_root) / root};
}
template <class T>
QUADCORE_LAW ScalarJet<T> inverse(const ScalarJet<T>& s) {
  const T i = 1 / s.x, di = -s.dx * i * i;
  return {i, di, (-s.ddx * i - 2 * s.dx * di) * i};
}
template <class T>
QUADCORE_LAW ScalarJet<T> norm(const Jet<T>& a) {
  return sqrt(dot(a, a));
}
/// Return the unit vector of a nonzero vector.
template <class T>
QUADCORE_LAW Jet<T> unit(const Jet<T>& a) {
  return inverse(norm(a)) * a;
}

}  // namespace quadcore::control
