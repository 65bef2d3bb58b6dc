#pragma once

#include "lanes/vec3.hpp"

/// \file
/// Dynamics of bodies on joints in linear time: R. Featherstone, "Rigid Body Dynamics Algorithms",
/// 2008, ch. 7. All vectors are in W and refer to the same point O for all bodies.

namespace quadcore::laws {

/// A spatial vector: the acceleration at O of a point that moves with a body and the angular
/// acceleration, or a force and its torque about O.
template <class T>
struct Spatial {
  Vec3<T> linear, angular;
};

template <class T>
QUADCORE_LAW Spatial<T> operator+(const Spatial<T>& a, const Spatial<T>& b) {
  return {a.linear + b.linear, a.angular + b.angular};
}
template <class T>
QUADCORE_LAW Spatial<T> operator-(const Spatial<T>& a, const Spatial<T>& b) {
  return {a.linear - b.linear, a.angular - b.angular};
}
template <class T>
QUADCORE_LAW Spatial<T> operator*(T factor, const Spatial<T>& a) {
  return {factor * a.linear, factor * a.angular};
}
/// Return the product of an acceleration and a load.
template <class T>
QUADCORE_LAW T dot(const Spatial<T>& a, const Spatial<T>& b) {
  return dot(a.linear, b.linear) + dot(a.angular, b.angular);
}

/// Return the load for an acceleration:
///   force = mass a + coupling alpha, torque = coupling^T a + inertia alpha.
template <class T>
struct SpatialInertia {
  Symmetric3<T> mass;
  Matrix3<T> coupling;
  Symmetric3<T> inertia;
};

template <class T>
QUADCORE_LAW Spatial<T> operator*(const SpatialInertia<T>& I, const Spatial<T>& a) {
  return {I.mass * a.linear + I.coupling * a.angular,
          inversely(I.coupling, a.linear) + I.inertia * a.angular};
}

/// sum += factor a a^T
template <class T>
QUADCORE_LAW void add_product(Symmetric3<T>& sum, T factor, const Vec3<T>& a) {
  const Vec3<T> b = factor * a;
  sum.xx = sum.xx + b.x * a.x;
  sum.xy = sum.xy + b.x * a.y;
  sum.xz = sum.xz + b.x * a.z;
  sum.yy = sum.yy + b.y * a.y;
  sum.yz = sum.yz + b.y * a.z;
  sum.zz = sum.zz + b.z * a.z;
}

/// sum += factor a b^T
template <class T>
QUADCORE_LAW void add_product(Matrix3<T>& sum, T factor, const Vec3<T>& a, const Vec3<T>& b) {
  const Vec3<T> c = factor * a;
  sum.xx = sum.xx + c.x * b.x;
  sum.xy = sum.xy + c.x * b.y;
  sum.xz = sum.xz + c.x * b.z;
  sum.yx = sum.yx + c.y * b.x;
  sum.yy = sum.yy + c.y * b.y;
  sum.yz = sum.yz + c.y * b.z;
  sum.zx = sum.zx + c.z * b.x;
  sum.zy = sum.zy + c.z * b.y;
  sum.zz = sum.zz + c.z * b.z;
}

/// Call f(a_i, b_i) for each pair of numbers of two loads or two inertias.
template <class T, class Function>
QUADCORE_LAW void for_each(Spatial<T>& a, const Spatial<T>& b, const Function& f) {
  f(a.linear.x, b.linear.x), f(a.linear.y, b.linear.y), f(a.linear.z, b.linear.z);
  f(a.angular.x, b.angular.x), f(a.angular.y, b.angular.y), f(a.angular.z, b.angular.z);
}
template <class T, class Function>
QUADCORE_LAW void for_each(Symmetric3<T>& a, const Symmetric3<T>& b, const Function& f) {
  f(a.xx, b.xx), f(a.xy, b.xy), f(a.xz, b.xz), f(a.yy, b.yy), f(a.yz, b.yz), f(a.zz, b.zz);
}
template <class T, class Function>
QUADCORE_LAW void for_each(SpatialInertia<T>& a, const SpatialInertia<T>& b, const Function& f) {
  for_each(a.mass, b.mass, f);
  Matrix3<T>& c = a.coupling;
  const Matrix3<T>& d = b.coupling;
  f(c.xx, d.xx), f(c.xy, d.xy), f(c.xz, d.xz), f(c.yx, d.yx), f(c.yy, d.yy), f(c.yz, d.yz);
  f(c.zx, d.zx), f(c.zy, d.zy), f(c.zz, d.zz);
  for_each(a.inertia, b.inertia, f);
}

/// Call f(a_i, a_i+1, a_i+2, a_i+3, b_i, b_i+1, b_i+2, b_i+3) for four pairs of numbers at a time,
/// and f(a_i, b_i) for the last ones.
template <class T, class Function>
QUADCORE_LAW void for_each_four(Spatial<T>& a, const Spatial<T>& b, const Function& f) {
  f(a.linear.x, a.linear.y, a.linear.z, a.angular.x, b.linear.x, b.linear.y, b.linear.z,
    b.angular.x);
  f(a.angular.y, b.angular.y), f(a.angular.z, b.angular.z);
}
template <class T, class Function>
QUADCORE_LAW void for_each_four(SpatialInertia<T>& a, const SpatialInertia<T>& b,
                                const Function& f) {
  Symmetric3<T>&m = a.mass, &I = a.inertia;
  const Symmetric3<T>&n = b.mass, &J = b.inertia;
  Matrix3<T>& c = a.coupling;
  const Matrix3<T>& d = b.coupling;
  f(m.xx, m.xy, m.xz, m.yy, n.xx, n.xy, n.xz, n.yy);
  f(m.yz, m.zz, c.xx, c.xy, n.yz, n.zz, d.xx, d.xy);
  f(c.xz, c.yx, c.yy, c.yz, d.xz, d.yx, d.yy, d.yz);
  f(c.zx, c.zy, c.zz, I.xx, d.zx, d.zy, d.zz, J.xx);
  f(I.xy, I.xz, I.yy, I.yz, J.xy, J.xz, J.yy, J.yz);
  f(I.zz, J.zz);
}

/// Return the inertia of a body with its centre of mass at p from O and the inertia I about it.
template <class T>
QUADCORE_LAW SpatialInertia<T> body_inertia(T mass, const Vec3<T>& p, const Symmetric3<T>& I) {
  const T none{};
  const Vec3<T> mp = mass * p;
  SpatialInertia<T> sum{{mass, none, none, mass, none, mass},
                        {none, mp.z, -mp.y, -mp.z, none, mp.x, mp.y, -mp.x, none},
                        I};
  const T all = dot(mp, p);
  sum.inertia.xx = sum.inertia.xx + all;
  sum.inertia.yy = sum.inertia.yy + all;
  sum.inertia.zz = sum.inertia.zz + all;
  add_product(sum.inertia, -mass, p);
  return sum;
}

/// Return the load on the same body.
template <class T>
QUADCORE_LAW Spatial<T> body_load(T mass, const Vec3<T>& p, const Symmetric3<T>& I,
                                  const Spatial<T>& a) {
  const Vec3<T> f = mass * (a.linear + cross(a.angular, p));
  return {f, I * a.angular + cross(p, f)};
}

template <class T>
QUADCORE_LAW Symmetric3<T> inverse(const Symmetric3<T>& m) {
  const T xx = m.yy * m.zz - m.yz * m.yz, xy = m.xz * m.yz - m.xy * m.zz,
          xz = m.xy * m.yz - m.xz * m.yy;
  const T by = 1 / (m.xx * xx + (m.xy * xy + m.xz * xz));
  return {by * xx,
          by * xy,
          by * xz,
          by * (m.xx * m.zz - m.xz * m.xz),
          by * (m.xy * m.xz - m.xx * m.yz),
          by * (m.xx * m.yy - m.xy * m.xy)};
}

/// Return the acceleration under a load by the Schur complement of the masses.
template <class T>
QUADCORE_LAW Spatial<T> solve(const SpatialInertia<T>& I, const Spatial<T>& load) {
  const Symmetric3<T> inverse_mass = inverse(I.mass);
  const Matrix3<T>& C = I.coupling;
  const Vec3<T> x{C.xx, C.yx, C.zx}, y{C.xy, C.yy, C.zy}, z{C.xz, C.yz, C.zz};
  const Vec3<T> of_x = inverse_mass * x, of_y = inverse_mass * y, of_z = inverse_mass * z;
  const Symmetric3<T> felt{I.inertia.xx - dot(x, of_x), I.inertia.xy - dot(x, of_y),
                           I.inertia.xz - dot(x, of_z), I.inertia.yy - dot(y, of_y),
                           I.inertia.yz - dot(y, of_z), I.inertia.zz - dot(z, of_z)};
  const Vec3<T>& f = load.linear;
  const Vec3<T> tau = load.angular - Vec3<T>{dot(of_x, f), dot(of_y, f), dot(of_z, f)};
  const Vec3<T> angular = inverse(felt) * tau;
  return {inverse_mass * (f - C * angular), angular};
}

/// A degree of freedom of a body relative to its carrier: an acceleration x in one direction, which
/// depends on the acceleration a of the carrier, x = start - give (load . a).
template <class T>
struct Freedom {
  Spatial<T> direction;
  Spatial<T> load;  ///< load for the direction, of the body and everything it carries
  T give, start;

  QUADCORE_LAW void add_to(Spatial<T>& a) const {
    a = a + (start - give * dot(load, a)) * direction;
  }
};

/// Return a free degree of freedom with the load of `force` along it.
template <class T>
QUADCORE_LAW Freedom<T> free_to(const Spatial<T>& direction, const Spatial<T>& load,
                                const Spatial<T>& force) {
  const T give = 1 / dot(direction, load);
  return {direction, load, give, give * dot(direction, force)};
}

/// Return a compliant degree of freedom with x = wanted - softness l under the load l along it.
template <class T>
QUADCORE_LAW Freedom<T> soft_to(const Spatial<T>& direction, const Spatial<T>& load,
                                const Spatial<T>& force, T wanted, T softness) {
  const T share = 1 / (1 + softness * dot(direction, load));
  return {direction, load, share * softness, share * (wanted + softness * dot(direction, force))};
}

/// Reduce the inertia of a body and the force on it to the part that acts on its carrier.
template <class T>
QUADCORE_LAW void eliminate(const Freedom<T>& freedom, SpatialInertia<T>& felt, Spatial<T>& force) {
  const Vec3<T>&f = freedom.load.linear, &tau = freedom.load.angular;
  add_product(felt.mass, -freedom.give, f);
  add_product(felt.coupling, -freedom.give, f, tau);
  add_product(felt.inertia, -freedom.give, tau);
  force = force - freedom.start * freedom.load;
}

}  // namespace quadcore::laws
