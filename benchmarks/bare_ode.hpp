#pragma once

#include <ode/ode.h>

#include <cmath>

/// \file
/// The thesis quadrotor at sim_slow 1 on bare ODE, as one writes it by hand for this vehicle alone:
/// what a step costs without URDF, plugins, engines to choose from, checks or a state to read.

namespace bare {

constexpr double dt = 0.001;
// The numbers that Gazebo's conversion of the URDF leaves: six digits, poses to the micrometre.
constexpr double frame_mass = 1, propeller_mass = 0.01;
constexpr double frame_inertia[3] = {0.00682292, 0.00682292, 0.0135417};
constexpr double propeller_inertia[3] = {1.40625e-5, 1.40625e-5, 2.8125e-5};
constexpr double arm = 0.2, propeller_z = 0.016827;
constexpr double thrust = 1.1487e-5, reaction = 2.69e-7, motor_gain = 0.0005;
constexpr double rotor_drag = 0.01 + 0.0025 + 0.005;  // induced, translational, profile
constexpr double parasitic_drag = 0.003;

class Quadrotor {
 public:
  explicit Quadrotor(double height) : world_(dWorldCreate()) {
    dWorldSetGravity(world_, 0, 0, -9.8);
    dWorldSetERP(world_, 0.2);
    dWorldSetCFM(world_, 0);
    frame_ = create_body(0, 0, height, frame_mass, frame_inertia);
    for (int i = 0; i < 4; ++i) {
      const double x = i == 0 ? arm : i == 2 ? -arm : 0, y = i == 3 ? arm : i == 1 ? -arm : 0;
      const double z = height + propeller_z;
      propellers_[i] = create_body(x, y, z, propeller_mass, propeller_inertia);
      hinges_[i] = dJointCreateHinge(world_, nullptr);
      dJointAttach(hinges_[i], propellers_[i], frame_);
      dJointSetHingeAnchor(hinges_[i], x, y, z);
      dJointSetHingeAxis(hinges_[i], 0, 0, 1);
    }
  }
  ~Quadrotor() { dWorldDestroy(world_); }
  Quadrotor(const Quadrotor&) = delete;
  Quadrotor& operator=(const Quadrotor&) = delete;

  /// Rotor speeds [rad/s], signed.
  void command(const double* speeds) {
    for (int i = 0; i < 4; ++i) targets_[i] = speeds[i];
  }

  void step(int n) {
    for (; n > 0; --n) {
      add_rotor_forces();
      add_gyroscopic_torque(frame_, frame_inertia);
      for (const dBodyID propeller : propellers_) {
        add_gyroscopic_torque(propeller, propeller_inertia);
      }
      dWorldStep(world_, dt);
    }
  }

  dBodyID frame() const { return frame_; }
  double rotor_rate(int i) const { return dJointGetHingeAngleRate(hinges_[i]); }

 private:
  dBodyID create_body(double x, double y, double z, double mass, const double* inertia) {
    dMass properties;
    dMassSetParameters(&properties, mass, 0, 0, 0, inertia[0], inertia[1], inertia[2], 0, 0, 0);
    const dBodyID body = dBodyCreate(world_);
    dBodySetMass(body, &properties);
    dBodySetPosition(body, x, y, z);
    dBodySetGyroscopicMode(body, 0);
    return body;
  }

  /// Appendix A.4 and A.5: thrust and drag in the propeller's own axes, parasitic drag with the
  /// components of the frame's world velocity in them, reaction on the frame, motor on the hinge.
  void add_rotor_forces() {
    const dReal* u = dBodyGetLinearVel(frame_);
    for (int i = 0; i < 4; ++i) {
      const double w = dJointGetHingeAngleRate(hinges_[i]);
      const dReal* v_world = dBodyGetLinearVel(propellers_[i]);
      dVector3 v;
      dBodyVectorFromWorld(propellers_[i], v_world[0], v_world[1], v_world[2], v);
      dBodyAddRelForce(propellers_[i], -rotor_drag * v[0] - parasitic_drag * std::abs(u[0]) * u[0],
                       -rotor_drag * v[1] - parasitic_drag * std::abs(u[1]) * u[1],
                       thrust * w * w - parasitic_drag * std::abs(u[2]) * u[2]);
      dBodyAddRelTorque(frame_, 0, 0, std::copysign(reaction * w * w, w));
      dJointAddHingeTorque(hinges_[i], -motor_gain * (w - targets_[i]));
    }
  }

  /// Gazebo's -w x (I w), with ODE's own gyroscopic mode off.
  static void add_gyroscopic_torque(dBodyID body, const double* I) {
    const dReal* w_world = dBodyGetAngularVel(body);
    dVector3 w;
    dBodyVectorFromWorld(body, w_world[0], w_world[1], w_world[2], w);
    dBodyAddRelTorque(body, (I[1] - I[2]) * w[1] * w[2], (I[2] - I[0]) * w[2] * w[0],
                      (I[0] - I[1]) * w[0] * w[1]);
  }

  dWorldID world_;
  dBodyID frame_;
  dBodyID propellers_[4];
  dJointID hinges_[4];
  double targets_[4] = {};
};

}  // namespace bare
