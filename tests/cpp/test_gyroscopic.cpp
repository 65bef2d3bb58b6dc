#include <memory>

#include "lopsided.hpp"
#include "ode/gyroscopic.hpp"
#include "quadcore/plugin/random.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

/// Bodies of a model that tumbles, apart from any engine, and how each moves.
struct Tumbling {
  Model model = lopsided(true);
  std::unique_ptr<dxWorld, void (*)(dWorldID)> world{dWorldCreate(), &dWorldDestroy};
  std::vector<dBodyID> bodies;
  std::vector<Matrix3d> R_WB;
  std::vector<Vector3d> w_W, axis_W;
  std::vector<double> rate;

  explicit Tumbling(double speed) {
    double count = 0;
    const auto draw = [&count] { return random_normal(3, count); };
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      Matrix3d R_WP = Matrix3d::Identity();
      Quaterniond turn(draw(), draw(), draw(), draw());
      if (i > 0) {
        const Joint& joint = model.joints[i - 1];
        R_WP = R_WB[joint.parent] * joint.pose.rotation();
        turn = Eigen::AngleAxisd(draw(), joint.axis);
      }
      R_WB.push_back(R_WP * turn.normalized());
      if (i == 0) {
        w_W.push_back(speed * Vector3d(draw(), draw(), draw()));
      } else {
        axis_W.push_back(R_WB[i] * model.joints[i - 1].axis);
        rate.push_back(60 * draw());
        w_W.push_back(w_W[model.joints[i - 1].parent] + rate.back() * axis_W.back());
      }
      bodies.push_back(dBodyCreate(world.get()));
      const Quaterniond q(R_WB[i]);
      const dQuaternion ode_q = {q.w(), q.x(), q.y(), q.z()};
      dBodySetQuaternion(bodies[i], ode_q);
      dBodySetAngularVel(bodies[i], w_W[i].x(), w_W[i].y(), w_W[i].z());
    }
  }

  std::size_t parent(std::size_t i) const { return model.joints[i - 1].parent; }
  Matrix3d inertia_W(std::size_t i) const {
    return R_WB[i] * model.links[i].inertial.inertia_in_link_axes() * R_WB[i].transpose();
  }
  /// -w x (I w) of a body.
  Vector3d torque_W(std::size_t i, const Vector3d& w) const { return -w.cross(inertia_W(i) * w); }
  /// What a hinge hands on.
  Vector3d across_W(std::size_t i, const Vector3d& tau) const {
    return tau - axis_W[i - 1].dot(tau) * axis_W[i - 1];
  }

  /// The frame's rate halfway through a step of the free vehicle, by plain iteration.
  Vector3d halfway_rate(double dt) const {
    const Matrix3d R = R_WB[0];
    // Joints at angle zero, as the law takes them: rotors that are not round make no difference.
    const std::vector<Eigen::Isometry3d> poses = link_poses(model);
    const Matrix3d whole_F = mass_properties(model).inertia_Ccm_F;
    Matrix3d carrier_F = whole_F, reduced_F = whole_F;
    for (std::size_t i = 1; i < bodies.size(); ++i) {
      const Matrix3d R_FB = poses[i].linear();
      const Matrix3d I = model.links[i].inertial.inertia_in_link_axes();
      const Vector3d c = model.links[i].inertial.pose.xyz, a = model.joints[i - 1].axis;
      const Vector3d arm = c - a.dot(c) * a;
      carrier_F -= R_FB * I * R_FB.transpose();
      reduced_F -= (a.dot(I * a) + model.links[i].inertial.mass * arm.squaredNorm()) * (R_FB * a) *
                   (R_FB * a).transpose();
    }
    Vector3d w = w_W[0];
    for (int n = 0; n < 200; ++n) {
      Vector3d tau = -w.cross(R * carrier_F * R.transpose() * w);
      for (std::size_t i = 1; i < bodies.size(); ++i) {
        if (parent(i) == 0) tau += across_W(i, torque_W(i, w + rate[i - 1] * axis_W[i - 1]));
      }
      w = w_W[0] + dt / 2 * (R * reduced_F.inverse() * R.transpose() * tau);
    }
    return w;
  }

  void check(const std::vector<Vector3d>& wanted_W) const {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      CAPTURE(i);
      const dReal* tau = dBodyGetTorque(bodies[i]);
      CHECK((Vector3d(tau[0], tau[1], tau[2]) - wanted_W[i]).norm() <
            1e-12 * (1 + wanted_W[i].norm()));
    }
  }
};

}  // namespace

TEST_CASE("Gazebo's gyroscopic torque acts on each body with its own rate") {
  dInitODE2(0);
  const Tumbling t(5);
  GyroscopicVehicle vehicle(t.model, t.bodies);
  add_gyroscopic_per_body(vehicle, 1e-3);
  std::vector<Vector3d> wanted_W;
  for (std::size_t i = 0; i < t.bodies.size(); ++i) {
    wanted_W.push_back(t.torque_W(i, t.w_W[i]));
  }
  t.check(wanted_W);
}

TEST_CASE(
    "the right gyroscopic torque is taken halfway, and what a hinge bears goes to its carrier") {
  dInitODE2(0);
  for (const double speed : {0.5, 5.0, 30.0}) {
    CAPTURE(speed);
    const Tumbling t(speed);
    constexpr double dt = 2e-3;
    GyroscopicVehicle vehicle(t.model, t.bodies);
    add_gyroscopic_from_carrier(vehicle, dt);
    const Vector3d halfway = t.halfway_rate(dt);
    std::vector<Vector3d> wanted_W = {t.torque_W(0, halfway)};
    for (std::size_t i = 1; i < t.bodies.size(); ++i) {
      const Vector3d w_C_W = t.parent(i) == 0 ? halfway : t.w_W[t.parent(i)];
      const Vector3d tau = t.torque_W(i, w_C_W + t.rate[i - 1] * t.axis_W[i - 1]);
      wanted_W.push_back(tau - t.across_W(i, tau));
      wanted_W[t.parent(i)] += t.across_W(i, tau);
    }
    t.check(wanted_W);
  }
}
