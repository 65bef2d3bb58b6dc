#pragma once

#include <cmath>

#include "quadcore/plugin/spatial.hpp"

namespace quadcore::control {

/// A vector and its first two time derivatives.
struct Jet {
  Vector3d x, dx, ddx;
};

/// A number and its first two time derivatives.
struct ScalarJet {
  double x, dx, ddx;
};

inline Jet operator+(const Jet& a, const Jet& b) { return {a.x + b.x, a.dx + b.dx, a.ddx + b.ddx}; }
inline Jet operator*(double factor, const Jet& a) {
  return {factor * a.x, factor * a.dx, factor * a.ddx};
}
inline Jet operator*(const ScalarJet& s, const Jet& a) {
  return {s.x * a.x, s.dx * a.x + s.x * a.dx, s.ddx * a.x + 2 * s.dx * a.dx + s.x * a.ddx};
}
inline Jet cross(const Jet& a, const Jet& b) {
  return {a.x.cross(b.x), a.dx.cross(b.x) + a.x.cross(b.dx),
          a.ddx.cross(b.x) + 2 * a.dx.cross(b.dx) + a.x.cross(b.ddx)};
}
inline ScalarJet dot(const Jet& a, const Jet& b) {
  return {a.x.dot(b.x), a.dx.dot(b.x) + a.x.dot(b.dx),
          a.ddx.dot(b.x) + 2 * a.dx.dot(b.dx) + a.x.dot(b.ddx)};
}
/// Return the square root of a positive number.
inline ScalarJet sqrt(const ScalarJet& s) {
  const double root = std::sqrt(s.x), d_root = s.dx / (2 * root);
  return {root, d_root, (s.ddx / 2 - d_root * d_root) / root};
}
inline ScalarJet inverse(const ScalarJet& s) {
  const double i = 1 / s.x, di = -s.dx * i * i;
  return {i, di, (-s.ddx * i - 2 * s.dx * di) * i};
}
inline ScalarJet norm(const Jet& a) { return sqrt(dot(a, a)); }
/// Return the unit vector of a nonzero vector.
inline Jet unit(const Jet& a) { return inverse(norm(a)) * a; }

}  // namespace quadcore::control
