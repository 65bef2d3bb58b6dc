#include "quadcore/control/flat_state.hpp"

#include "flat_table.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::control {

FlatState flat_state(const Reference& wanted, const ModelledVehicle& model, bool with_drag) {
  FlatTable table(model, with_drag);
  table.set(0, wanted);
  table.solve(1);
  std::optional<FlatState> flat = table.state(0);
  if (!flat) {
    throw Error(
        "the reference has no defined attitude: it is in free fall, or its thrust points along its "
        "own x axis.");
  }
  return *flat;
}

Vector3d across_yaw(double yaw) {
  const auto [s, c] = elementary::sincos(yaw);
  return {-s, c, 0};
}

Matrix3d attitude_of(const Vector3d& z_W, const Vector3d& across_W) {
  const Vector3d z = z_W.normalized();
  const Vector3d x = across_W.cross(z).normalized();
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
