#pragma once

#include <cmath>

#include "quadcore/plugin/model.hpp"

namespace bare {

/// The floor under the engine eigen: the thesis' quadrotor as a gyrostat with its chapter-2 forces,
/// classical Runge-Kutta, everything in one function of plain numbers. No plugins, no engine, no
/// vehicle but this one: rotors stand upright, the vehicle's products of inertia vanish.
class Gyrostat {
 public:
  Gyrostat(const quadcore::Model& model, double height) {
    const quadcore::MassProperties total = quadcore::mass_properties(model);
    mass_ = total.mass;
    moment_ = model.links[1].inertial.inertia(2, 2);
    for (int j = 0; j < 3; ++j) inertia_[j] = total.inertia_Ccm_F(j, j);
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 3; ++j) arm_[i][j] = model.joints[i].pose.xyz[j] - total.p_FCcm[j];
    }
    center_ = total.p_FCcm.z();
    s_[2] = height + center_;
    s_[6] = 1;
  }

  void command(const double* speeds) {
    for (int i = 0; i < 4; ++i) command_[i] = speeds[i];
  }

  void step(int n) {
    double k[4][size], t[size];
    for (; n > 0; --n) {
      rate(s_, k[0]);
      for (int i = 0; i < size; ++i) t[i] = s_[i] + dt / 2 * k[0][i];
      rate(t, k[1]);
      for (int i = 0; i < size; ++i) t[i] = s_[i] + dt / 2 * k[1][i];
      rate(t, k[2]);
      for (int i = 0; i < size; ++i) t[i] = s_[i] + dt * k[2][i];
      rate(t, k[3]);
      for (int i = 0; i < size; ++i) {
        s_[i] += dt / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
      }
      double norm = 0;
      for (int i = 3; i < 7; ++i) norm += s_[i] * s_[i];
      norm = 1 / std::sqrt(norm);
      for (int i = 3; i < 7; ++i) s_[i] *= norm;
    }
  }

  /// Position of the frame's origin [m].
  quadcore::Vector3d position() const {
    const quadcore::Quaterniond q(s_[6], s_[3], s_[4], s_[5]);
    return quadcore::Vector3d(s_[0], s_[1], s_[2]) - q * quadcore::Vector3d(0, 0, center_);
  }

 private:
  // Position and velocity of the centre of mass in the world, quaternion x y z w, body rates,
  // rotors.
  static constexpr int size = 17;
  static constexpr double dt = 0.001, g = 9.8;
  static constexpr double thrust = 1.1487e-5, torque = 2.69e-7, drag = 0.01 + 0.0025 + 0.005;
  static constexpr double parasitic = 0.003, gain = 0.0005;

  void rate(const double* s, double* d) const {
    const double *q = s + 3, *v = s + 7, *w = s + 10, *W = s + 13;
    const double x = q[0], y = q[1], z = q[2], u = q[3];
    const double R[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - u * z), 2 * (x * z + u * y)},
                            {2 * (x * y + u * z), 1 - 2 * (x * x + z * z), 2 * (y * z - u * x)},
                            {2 * (x * z - u * y), 2 * (y * z + u * x), 1 - 2 * (x * x + y * y)}};
    double V[3], F[3] = {0, 0, 0}, T[3] = {0, 0, 0}, spin = 0, motors = 0;
    for (int j = 0; j < 3; ++j) V[j] = R[0][j] * v[0] + R[1][j] * v[1] + R[2][j] * v[2];
    for (int i = 0; i < 4; ++i) {
      const double* r = arm_[i];
      const double fx = -drag * (V[0] + w[1] * r[2] - w[2] * r[1]);
      const double fy = -drag * (V[1] + w[2] * r[0] - w[0] * r[2]);
      const double fz = thrust * W[i] * W[i];
      F[0] += fx;
      F[1] += fy;
      F[2] += fz;
      T[0] += r[1] * fz - r[2] * fy;
      T[1] += r[2] * fx - r[0] * fz;
      T[2] += r[0] * fy - r[1] * fx + std::copysign(torque * W[i] * W[i], W[i]);
      d[13 + i] = gain * (command_[i] - W[i]);
      spin += moment_ * W[i];
      motors += d[13 + i];
    }
    const double air = parasitic * std::sqrt(V[0] * V[0] + V[1] * V[1] + V[2] * V[2]);
    for (int j = 0; j < 3; ++j) F[j] -= air * V[j];
    const double H[3] = {inertia_[0] * w[0], inertia_[1] * w[1], inertia_[2] * w[2] + spin};
    const double a[3] = {(T[0] - w[1] * H[2] + w[2] * H[1]) / inertia_[0],
                         (T[1] - w[2] * H[0] + w[0] * H[2]) / inertia_[1],
                         (T[2] - w[0] * H[1] + w[1] * H[0] - motors) / (inertia_[2] - 4 * moment_)};
    for (int j = 0; j < 3; ++j) {
      d[j] = v[j];
      d[7 + j] = (R[j][0] * F[0] + R[j][1] * F[1] + R[j][2] * F[2]) / mass_;
      d[10 + j] = a[j];
    }
    d[9] -= g;
    d[3] = 0.5 * (u * w[0] + y * w[2] - z * w[1]);
    d[4] = 0.5 * (u * w[1] + z * w[0] - x * w[2]);
    d[5] = 0.5 * (u * w[2] + x * w[1] - y * w[0]);
    d[6] = -0.5 * (x * w[0] + y * w[1] + z * w[2]);
    for (int i = 0; i < 4; ++i) d[13 + i] = d[13 + i] / moment_ - a[2];
  }

  double mass_, moment_, center_, inertia_[3], arm_[4][3], command_[4] = {};
  double s_[size] = {};
};

}  // namespace bare
