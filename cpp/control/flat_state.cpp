#include "quadcore/control/flat_state.hpp"

#include "jet.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::control {
namespace {

/// Return the unit vector perpendicular to the vertical plane of the yaw.
Jet across(double yaw, double rate, double acceleration) {
  const auto [s, c] = elementary::sincos(yaw);
  const Vector3d y(-s, c, 0), minus_x(-c, -s, 0);
  return {y, rate * minus_x, acceleration * minus_x - rate * rate * y};
}

/// Return the force of the rotors in W, apart from a part along z of F.
Jet force(const Reference& wanted, const ModelledVehicle& model, bool with_drag) {
  const Vector3d up(0, 0, model.gravity);
  const Jet a{wanted.acceleration + up, wanted.jerk, wanted.snap};
  if (!with_drag) return model.mass * a;
  const Jet v{wanted.velocity, wanted.acceleration, wanted.jerk};
  const double d = (model.air.linear(0, 0) + model.air.linear(1, 1)) / 2;
  const Jet with_linear = model.mass * a + d * v;
  if (model.air.quadratic == 0 || v.x.isZero(0)) return with_linear;
  return with_linear + model.air.quadratic * (norm(v) * v);
}

/// Number of fixed-point iterations: attitude and reference of the centre of mass depend on each
/// other. They converge quickly for a centre of mass near the origin.
constexpr int rounds = 2;

/// Return the rotation of a vehicle whose centre of mass follows a reference exactly.
FlatState attitude_along(const Reference& wanted, const ModelledVehicle& model, bool with_drag) {
  const Jet f_W = force(wanted, model, with_drag);
  const Jet z = unit(f_W);
  const Jet x = unit(cross(across(wanted.yaw, wanted.yaw_rate, wanted.yaw_acceleration), z));
  const Jet y = cross(z, x);
  FlatState flat{};
  flat.R_WF << x.x, y.x, z.x;
  if (!flat.R_WF.allFinite()) {
    throw Error(
        "the reference has no defined attitude: it is in free fall, or its thrust points along its "
        "own x axis.");
  }
  // R' = R [w x], hence w = (z . y', x . z', y . x').
  flat.w_WF_F << z.x.dot(y.dx), x.x.dot(z.dx), y.x.dot(x.dx);
  flat.dw_WF_F << z.dx.dot(y.dx) + z.x.dot(y.ddx), x.dx.dot(z.dx) + x.x.dot(z.ddx),
      y.dx.dot(x.dx) + y.x.dot(x.ddx);
  return flat;
}

}  // namespace

FlatState flat_state(const Reference& wanted, const ModelledVehicle& model, bool with_drag) {
  FlatState flat = attitude_along(wanted, model, with_drag);
  if (!model.p_FCcm_F.isZero(0)) {
    for (int round = 0; round < rounds; ++round) {
      flat = attitude_along(at_centre_of_mass(wanted, model, flat), model, with_drag);
    }
    flat.a_FCcm_W = at_centre_of_mass(wanted, model, flat).acceleration - wanted.acceleration;
  }
  const Vector3d up(0, 0, model.gravity);
  Vector3d exerted_W = model.mass * (wanted.acceleration + flat.a_FCcm_W + up);
  if (with_drag) exerted_W -= model.air_force_W(flat.R_WF, wanted.velocity, flat.w_WF_F);
  flat.thrust = flat.R_WF.col(2).dot(exerted_W);
  return flat;
}

Reference at_centre_of_mass(const Reference& wanted, const ModelledVehicle& model,
                            const FlatState& flat) {
  const Vector3d &r_F = model.p_FCcm_F, &w_F = flat.w_WF_F, &dw_F = flat.dw_WF_F;
  // Each derivative in W is the derivative in F plus w x; primes denote derivatives in F.
  const Vector3d v_F = w_F.cross(r_F);
  const Vector3d dv_F = dw_F.cross(r_F);
  const Vector3d a_F = w_F.cross(v_F) + dv_F;
  const Vector3d da_F = dw_F.cross(v_F) + w_F.cross(dv_F);
  const Vector3d j_F = w_F.cross(a_F) + da_F;
  const Vector3d dda_F = 2 * dw_F.cross(dv_F);
  const Vector3d dj_F = dw_F.cross(a_F) + w_F.cross(da_F) + dda_F;
  const Vector3d s_F = w_F.cross(j_F) + dj_F;
  Reference centre = wanted;
  centre.position += flat.R_WF * r_F;
  centre.velocity += flat.R_WF * v_F;
  centre.acceleration += flat.R_WF * a_F;
  centre.jerk += flat.R_WF * j_F;
  centre.snap += flat.R_WF * s_F;
  return centre;
}

Matrix3d attitude_of(const Vector3d& z_W, double yaw) {
  const Vector3d z = z_W.normalized();
  const Vector3d x = across(yaw, 0, 0).x.cross(z).normalized();
  Matrix3d R;
  R << x, z.cross(x), z;
  return R;
}

Vector3d torque_for(const ModelledVehicle& model, const Vector3d& dw_WF_F, const Vector3d& w_WF_F,
                    const Vector3d& h_F, const Vector3d& tau_air_F) {
  const Matrix3d& I = model.inertia_Ccm_F;
  return I * dw_WF_F + w_WF_F.cross(I * w_WF_F + h_F) - tau_air_F;
}

}  // namespace quadcore::control
