#include "quadcore/control/flat_state.hpp"

#include "flat_table.hpp"
#include "numbers.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::control {

FlatState flat_state(const Reference& wanted, const ModelledVehicle& model, bool with_drag) {
  FlatTable table(model, with_drag);
  table.set(0, wanted, elementary::sincos(wanted.yaw));
  table.solve(1);
  if (!table.is_defined(0)) {
    throw Error(
        "the reference has no defined attitude: it is in free fall, or its thrust points along its "
        "own x axis.");
  }
  return table.state(0);
}

Vector3d across_yaw(double yaw) {
  const auto [s, c] = elementary::sincos(yaw);
  return {-s, c, 0};
}

Vector3d torque_for(const ModelledVehicle& model, const Vector3d& dw_WF_F, const Vector3d& w_WF_F,
                    const Vector3d& h_F, const Vector3d& tau_air_F) {
  return vector_of(torque_for(numbers_of(model.inertia_Ccm_F), numbers_of(dw_WF_F),
                              numbers_of(w_WF_F), numbers_of(h_F), numbers_of(tau_air_F)));
}

}  // namespace quadcore::control
