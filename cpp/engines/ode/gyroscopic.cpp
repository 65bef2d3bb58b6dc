#include "gyroscopic.hpp"

#include "ode_math.hpp"

namespace quadcore {
namespace {

void add_torque(dBodyID body, const Vector3d& tau_W) {
  dBodyAddTorque(body, tau_W.x(), tau_W.y(), tau_W.z());
}

}  // namespace

void add_gyroscopic_per_body(const std::vector<GyroscopicBody>& bodies) {
  for (const GyroscopicBody& b : bodies) {
    const Matrix3d R_WB = rotation(dBodyGetRotation(b.body));
    const Vector3d w_WB_W = vec(dBodyGetAngularVel(b.body));
    const Vector3d h_W = R_WB * (b.I_Bcm_B * (R_WB.transpose() * w_WB_W));
    add_torque(b.body, -w_WB_W.cross(h_W));
  }
}

void add_gyroscopic_from_carrier(const std::vector<GyroscopicBody>& bodies) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const GyroscopicBody& b = bodies[i];
    const Matrix3d R_WB = rotation(dBodyGetRotation(b.body));
    if (i == 0) {
      const Vector3d w_WF_F = R_WB.transpose() * vec(dBodyGetAngularVel(b.body));
      add_torque(b.body, R_WB * -w_WF_F.cross(b.I_Bcm_B * w_WF_F));
      continue;
    }
    const dBodyID carrier = bodies[b.parent].body;
    const Vector3d w_WC_B = R_WB.transpose() * vec(dBodyGetAngularVel(carrier));
    const Vector3d w_WB_B = R_WB.transpose() * vec(dBodyGetAngularVel(b.body));
    const double rate = b.axis_B.dot(w_WB_B - w_WC_B);
    const Vector3d w_B = w_WC_B + rate * b.axis_B;
    const Vector3d tau_B = -w_B.cross(b.I_Bcm_B * w_B);
    const Vector3d along_B = b.axis_B.dot(tau_B) * b.axis_B;
    add_torque(b.body, R_WB * along_B);
    add_torque(carrier, R_WB * (tau_B - along_B));
  }
}

}  // namespace quadcore
