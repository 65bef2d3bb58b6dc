#include "air_force.hpp"
#include "flat_states.hpp"
#include "jet.hpp"
#include "lanes/table.hpp"

namespace quadcore::control {
namespace {

using laws::Matrix3;
using laws::Vec3;

/// Number of fixed-point iterations: attitude and reference of the centre of mass depend on each
/// other. They converge quickly for a centre of mass near the origin.
constexpr int rounds = 2;

/// Derivatives of a position.
template <class T>
struct Derivatives {
  Vec3<T> velocity, acceleration, jerk, snap;
};

/// Rotation of a vehicle whose centre of mass follows a reference exactly.
template <class T>
struct Turning {
  Matrix3<T> R_WF;
  Vec3<T> w_WF_F, dw_WF_F;
};

/// Return the unit vector perpendicular to the vertical plane of the yaw.
template <class T>
QUADCORE_LAW Jet<T> across(T sine, T cosine, T rate, T acceleration) {
  const Vec3<T> y{-sine, cosine, T{}}, minus_x{-cosine, -sine, T{}};
  return {y, rate * minus_x, acceleration * minus_x - (rate * rate) * y};
}

/// Return the force of the rotors in W, apart from a part along z of F.
template <class T>
QUADCORE_LAW Jet<T> force(const FlatVehicle& vehicle, const Derivatives<T>& wanted) {
  const Vec3<T> up{T{}, T{}, laws::broadcast<T>(vehicle.gravity)};
  const Jet<T> f = vehicle.mass * Jet<T>{wanted.acceleration + up, wanted.jerk, wanted.snap};
  if (!vehicle.with_drag) return f;
  const Jet<T> v{wanted.velocity, wanted.acceleration, wanted.jerk};
  const Jet<T> with_linear = f + vehicle.mean_drag * v;
  if (vehicle.air.quadratic == 0) return with_linear;
  const Jet<T> with_both = with_linear + vehicle.air.quadratic * (norm(v) * v);
  const auto rests = (v.x.x == 0.0) & (v.x.y == 0.0) & (v.x.z == 0.0);  // where the norm has a kink
  const auto chosen = [&](const Vec3<T>& at_rest, const Vec3<T>& moving) -> Vec3<T> {
    return {laws::chosen_by(rests, at_rest.x, moving.x),
            laws::chosen_by(rests, at_rest.y, moving.y),
            laws::chosen_by(rests, at_rest.z, moving.z)};
  };
  return {chosen(with_linear.x, with_both.x), chosen(with_linear.dx, with_both.dx),
          chosen(with_linear.ddx, with_both.ddx)};
}

template <class T>
QUADCORE_LAW Turning<T> turning_along(const FlatVehicle& vehicle, const Derivatives<T>& wanted,
                                      const Jet<T>& across) {
  const Jet<T> z = unit(force(vehicle, wanted));
  const Jet<T> x = unit(cross(across, z));
  const Jet<T> y = cross(z, x);
  // R' = R [w x], hence w = (z . y', x . z', y . x').
  return {{x.x.x, y.x.x, z.x.x, x.x.y, y.x.y, z.x.y, x.x.z, y.x.z, z.x.z},
          {dot(z.x, y.dx), dot(x.x, z.dx), dot(y.x, x.dx)},
          {dot(z.dx, y.dx) + dot(z.x, y.ddx), dot(x.dx, z.dx) + dot(x.x, z.ddx),
           dot(y.dx, x.dx) + dot(y.x, x.ddx)}};
}

/// Return the derivatives of the position of the centre of mass if the origin of F follows a
/// reference in this attitude. With the offset r they are v + w x r, a + w' x r + w x (w x r) and
/// so on. Because a reference ends with the snap, the second and third derivatives of w in F are
/// taken as zero, as in a steady turn.
template <class T>
QUADCORE_LAW Derivatives<T> of_centre_of_mass(const Derivatives<T>& wanted, const Vec3<T>& r_F,
                                              const Turning<T>& turning) {
  const Vec3<T>&w_F = turning.w_WF_F, &dw_F = turning.dw_WF_F;
  const Matrix3<T>& R = turning.R_WF;
  // Each derivative in W is the derivative in F plus w x; primes denote derivatives in F.
  const Vec3<T> v_F = cross(w_F, r_F);
  const Vec3<T> dv_F = cross(dw_F, r_F);
  const Vec3<T> a_F = cross(w_F, v_F) + dv_F;
  const Vec3<T> da_F = cross(dw_F, v_F) + cross(w_F, dv_F);
  const Vec3<T> j_F = cross(w_F, a_F) + da_F;
  const Vec3<T> dda_F = 2.0 * cross(dw_F, dv_F);
  const Vec3<T> dj_F = cross(dw_F, a_F) + cross(w_F, da_F) + dda_F;
  const Vec3<T> s_F = cross(w_F, j_F) + dj_F;
  return {wanted.velocity + R * v_F, wanted.acceleration + R * a_F, wanted.jerk + R * j_F,
          wanted.snap + R * s_F};
}

template <class T>
QUADCORE_LAW void store_vector(double* rows, const Vec3<T>& a) {
  laws::store(rows, a.x);
  laws::store(rows + widest_lanes, a.y);
  laws::store(rows + 2 * widest_lanes, a.z);
}

template <class T>
QUADCORE_LAW void solve(const FlatVehicle& vehicle, double* columns) {
  const laws::Table<T, widest_lanes> table{columns};
  const Derivatives<T> wanted{table.vector(FlatRow::velocity), table.vector(FlatRow::acceleration),
                              table.vector(FlatRow::jerk), table.vector(FlatRow::snap)};
  const Jet<T> y = across(table.number(FlatRow::sine), table.number(FlatRow::cosine),
                          table.number(FlatRow::yaw_rate), table.number(FlatRow::yaw_acceleration));
  const Vec3<T> r_F = laws::broadcast<T>(vehicle.p_FCcm_F);
  Turning<T> turning = turning_along(vehicle, wanted, y);
  Vec3<T> a_FCcm_W{T{}, T{}, T{}};
  if (vehicle.is_offset) {
    for (int round = 0; round < rounds; ++round) {
      turning = turning_along(vehicle, of_centre_of_mass(wanted, r_F, turning), y);
    }
    a_FCcm_W = of_centre_of_mass(wanted, r_F, turning).acceleration - wanted.acceleration;
  }
  const Vec3<T> up{T{}, T{}, laws::broadcast<T>(vehicle.gravity)};
  Vec3<T> exerted_W = vehicle.mass * (wanted.acceleration + a_FCcm_W + up);
  if (vehicle.with_drag) {
    const Vec3<T> v_F = inversely(turning.R_WF, wanted.velocity) + cross(turning.w_WF_F, r_F);
    exerted_W = exerted_W - turning.R_WF * air_force_F(vehicle.air, turning.R_WF, v_F);
  }
  const Matrix3<T>& R = turning.R_WF;
  double* const rotation = columns + FlatRow::R_WF * widest_lanes;
  store_vector(rotation, Vec3<T>{R.xx, R.yx, R.zx});
  store_vector(rotation + 3 * widest_lanes, Vec3<T>{R.xy, R.yy, R.zy});
  store_vector(rotation + 6 * widest_lanes, Vec3<T>{R.xz, R.yz, R.zz});
  store_vector(columns + FlatRow::w_WF_F * widest_lanes, turning.w_WF_F);
  store_vector(columns + FlatRow::dw_WF_F * widest_lanes, turning.dw_WF_F);
  store_vector(columns + FlatRow::w_WF_W * widest_lanes, R * turning.w_WF_F);
  store_vector(columns + FlatRow::dw_WF_W * widest_lanes, R * turning.dw_WF_F);
  store_vector(columns + FlatRow::a_FCcm_W * widest_lanes, a_FCcm_W);
  laws::store(columns + FlatRow::thrust * widest_lanes, dot(Vec3<T>{R.xz, R.yz, R.zz}, exerted_W));
}

}  // namespace

template <int W>
void solve_flat_states(const FlatVehicle& vehicle, double* table, std::size_t columns) {
  for (std::size_t i = 0; i < columns; i += W) solve<laws::Pack<W>>(vehicle, table + i);
}

template void solve_flat_states<QUADCORE_LANES>(const FlatVehicle&, double*, std::size_t);

}  // namespace quadcore::control
