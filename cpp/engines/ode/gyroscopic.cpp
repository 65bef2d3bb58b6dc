#include "gyroscopic.hpp"

#include "ode_math.hpp"

namespace quadcore {
namespace {

void add_torque(dBodyID body, const Vector3d& tau_W) {
  dBodyAddTorque(body, tau_W.x(), tau_W.y(), tau_W.z());
}

/// Return -u x (I u) in any axes.
Vector3d gyroscopic(const Matrix3d& I, const Vector3d& u) { return -u.cross(I * u); }

/// Return its derivative with respect to u.
Matrix3d gyroscopic_slope(const Matrix3d& I, const Vector3d& u) {
  return skew(I * u) - skew(u) * I;
}

Vector3d torque(const HingedBody& b, const Vector3d& w_WC_C) {
  return gyroscopic(b.I_Bcm_C, w_WC_C + b.rate * b.axis_C);
}

/// Return the part of a torque that the hinge transmits to the carrier.
Matrix3d across(const Vector3d& axis) { return Matrix3d::Identity() - axis * axis.transpose(); }

/// Return the frame's angular velocity halfway through a step of dt without loads:
///   w_m = w + dt/2 I^-1 tau(w_m), tau the gyroscopic torque on the vehicle, by Newton's method.
Vector3d halfway_rate(const GyroscopicVehicle& vehicle, const Vector3d& w_WF_F, double dt) {
  constexpr int most = 8;              // 2 or 3 are needed at 50 rad/s and 1 ms
  constexpr double converged = 1e-15;  // relative to the rate
  const Matrix3d half_dt_inverse_I_F = dt / 2 * vehicle.inverse_reduced_I_F;
  Vector3d w_F = w_WF_F;
  for (int n = 0; n < most; ++n) {
    Vector3d tau_F = gyroscopic(vehicle.I_frame_and_masses_F, w_F);
    Matrix3d slope_F = gyroscopic_slope(vehicle.I_frame_and_masses_F, w_F);
    for (std::size_t i = 0; i < vehicle.hinged.size(); ++i) {
      if (vehicle.bodies[i + 1].parent != 0) continue;
      const HingedBody& rotor = vehicle.hinged[i];
      const Matrix3d to_frame = across(rotor.axis_C);
      tau_F += to_frame * torque(rotor, w_F);
      slope_F += to_frame * gyroscopic_slope(rotor.I_Bcm_C, w_F + rotor.rate * rotor.axis_C);
    }
    const Vector3d residual = w_F - w_WF_F - half_dt_inverse_I_F * tau_F;
    const Matrix3d slope = Matrix3d::Identity() - half_dt_inverse_I_F * slope_F;
    const Vector3d change = slope.inverse() * residual;
    w_F -= change;
    if (change.norm() <= converged * w_F.norm()) break;
  }
  return w_F;
}

}  // namespace

HingedBody::HingedBody(const GyroscopicBody& b, dBodyID carrier) {
  const Matrix3d R_CW = rotation(dBodyGetRotation(carrier)).transpose();
  const Matrix3d R_CB = R_CW * rotation(dBodyGetRotation(b.body));
  axis_C = R_CB * b.axis_B;
  I_Bcm_C = R_CB * b.I_Bcm_B * R_CB.transpose();
  rate = axis_C.dot(R_CW * (vec(dBodyGetAngularVel(b.body)) - vec(dBodyGetAngularVel(carrier))));
}

GyroscopicVehicle::GyroscopicVehicle(const Model& model, const std::vector<dBodyID>& ode_bodies) {
  const std::vector<Eigen::Isometry3d> poses = link_poses(model);
  I_frame_and_masses_F = mass_properties(model).inertia_Ccm_F;
  Matrix3d reduced_I_F = I_frame_and_masses_F;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const Matrix3d I = model.links[i].inertial.inertia_in_link_axes();
    if (i == 0) {
      bodies.push_back({ode_bodies[0], 0, Vector3d::Zero(), I});
      continue;
    }
    const Joint& joint = model.joints[i - 1];
    bodies.push_back({ode_bodies[i], joint.parent, joint.axis, I});
    const Matrix3d R_FB = poses[i].linear();
    const Vector3d axis_F = R_FB * joint.axis;
    I_frame_and_masses_F -= R_FB * I * R_FB.transpose();
    reduced_I_F -= moment_about_joint(model, i - 1) * axis_F * axis_F.transpose();
  }
  hinged.reserve(model.joints.size());
  inverse_reduced_I_F = reduced_I_F.inverse();
}

void add_gyroscopic_per_body(GyroscopicVehicle& vehicle, double) {
  for (const GyroscopicBody& b : vehicle.bodies) {
    const Matrix3d R_WB = rotation(dBodyGetRotation(b.body));
    const Vector3d w_WB_W = vec(dBodyGetAngularVel(b.body));
    const Vector3d h_W = R_WB * (b.I_Bcm_B * (R_WB.transpose() * w_WB_W));
    add_torque(b.body, -w_WB_W.cross(h_W));
  }
}

void add_gyroscopic_from_carrier(GyroscopicVehicle& vehicle, double dt) {
  vehicle.hinged.clear();
  for (std::size_t i = 1; i < vehicle.bodies.size(); ++i) {
    const GyroscopicBody& b = vehicle.bodies[i];
    vehicle.hinged.emplace_back(b, vehicle.bodies[b.parent].body);
  }
  const GyroscopicBody& frame = vehicle.bodies[0];
  const Matrix3d R_WF = rotation(dBodyGetRotation(frame.body));
  const Vector3d w_WF_F =
      halfway_rate(vehicle, R_WF.transpose() * vec(dBodyGetAngularVel(frame.body)), dt);
  add_torque(frame.body, R_WF * gyroscopic(frame.I_Bcm_B, w_WF_F));
  for (std::size_t i = 1; i < vehicle.bodies.size(); ++i) {
    const GyroscopicBody& b = vehicle.bodies[i];
    const HingedBody& rotor = vehicle.hinged[i - 1];
    const dBodyID carrier = vehicle.bodies[b.parent].body;
    const Matrix3d R_WC = rotation(dBodyGetRotation(carrier));
    Vector3d w_WC_C = w_WF_F;
    if (b.parent != 0) w_WC_C = R_WC.transpose() * vec(dBodyGetAngularVel(carrier));
    const Vector3d tau_C = torque(rotor, w_WC_C);
    const Vector3d across_C = across(rotor.axis_C) * tau_C;
    add_torque(b.body, R_WC * (tau_C - across_C));
    add_torque(carrier, R_WC * across_C);
  }
}

}  // namespace quadcore
