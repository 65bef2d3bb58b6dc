#include <cmath>

#include "lopsided.hpp"
#include "quadcore/plugin/random.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

Vector3d draw(double& count) {
  return {random_normal(9, count), random_normal(9, count), random_normal(9, count)};
}

VehicleState moving(std::size_t rotors) {
  double count = 100;
  VehicleState state;
  state.position = draw(count);
  state.orientation = Quaterniond(random_normal(9, count), random_normal(9, count),
                                  random_normal(9, count), random_normal(9, count))
                          .normalized();
  state.linear_velocity = 2 * draw(count);
  state.angular_velocity = 2 * draw(count);
  state.rotor_velocity = state.rotor_angle = VectorXd::Zero(static_cast<Eigen::Index>(rotors));
  for (Eigen::Index i = 0; i < state.rotor_velocity.size(); ++i) {
    state.rotor_velocity[i] = 50 * random_normal(9, count);
    state.rotor_angle[i] = random_normal(9, count);
  }
  return state;
}

/// Loads of every kind that stay as they are.
struct Pushes final : ForceField {
  Vector3d force_F, point_F, torque_F;
  std::vector<Vector3d> rotor_forces_F;
  std::vector<double> joint_torques;

  explicit Pushes(std::size_t rotors) {
    double count = 0;
    force_F = 3 * draw(count);
    point_F = 0.2 * draw(count);
    torque_F = 0.05 * draw(count);
    for (std::size_t i = 0; i < rotors; ++i) {
      rotor_forces_F.push_back(0.5 * draw(count));
      joint_torques.push_back(2e-3 * random_normal(9, count));
    }
  }

  void evaluate(Kinematics&, Loads& loads) const override {
    loads.add_frame_force(0, force_F, point_F);
    loads.add_frame_torque(0, torque_F);
    for (std::size_t i = 0; i < joint_torques.size(); ++i) {
      loads.add_rotor_force(0, i, rotor_forces_F[i]);
      loads.add_joint_torque(i, joint_torques[i]);
    }
  }
};

/// Momenta of a model in motion, from the definitions; world axes.
struct Momenta {
  Vector3d linear = Vector3d::Zero();
  Vector3d angular = Vector3d::Zero();                   ///< about the world's origin
  std::vector<Vector3d> linear_of_rotor, spin_of_rotor;  ///< the spin is about its centre of mass

  Momenta(const Model& model, const Kinematics& k) {
    const auto add = [this](const Vector3d& p, const Vector3d& l, const Vector3d& spin) {
      linear += l;
      angular += p.cross(l) + spin;
    };
    const Inertial& frame = model.links[0].inertial;
    const Vector3d p_F = frame.pose.xyz;
    add(k.p_WF + k.R_WF * p_F, frame.mass * (k.R_WF * (k.v_WF_F + k.w_WF_F.cross(p_F))),
        k.R_WF * (frame.inertia_in_link_axes() * k.w_WF_F));
    std::vector<Vector3d> w_F = {k.w_WF_F};
    for (std::size_t i = 0; i < model.joints.size(); ++i) {
      const RotorKinematics& rotor = k.rotors[i];
      const Inertial& inertial = model.links[i + 1].inertial;
      w_F.push_back(w_F[model.joints[i].parent] + rotor.rate * rotor.axis_F);
      const Matrix3d R_WR = k.R_WF * k.R_FR(i);
      linear_of_rotor.push_back(inertial.mass * (k.R_WF * rotor.v_WRcm_F));
      spin_of_rotor.push_back(
          R_WR * (inertial.inertia_in_link_axes() * (R_WR.transpose() * (k.R_WF * w_F.back()))));
      add(k.p_WF + k.R_WF * rotor.p_FRcm_F, linear_of_rotor.back(), spin_of_rotor.back());
    }
  }
};

/// Compares a step of an engine with the balances of momentum of the whole and of each rotor.
void check_balances(const std::string& name, const Model& model, const World& world) {
  constexpr double dt = 1e-6;
  const auto engine = make_engine(name, model, world);
  const Model& flown = engine->model();
  const std::size_t rotors = flown.joints.size();
  const Pushes pushes(rotors);
  engine->set_state(moving(rotors));
  // ODE lets a hinge lag behind by a part of a step; in the end the lag is the same at each step.
  for (int i = 0; i < 60; ++i) engine->step(0, dt, pushes);
  const Kinematics before = engine->kinematics();
  const Momenta a(flown, before);
  engine->step(0, dt, pushes);
  const Momenta b(flown, engine->kinematics());

  const double mass = mass_properties(flown).mass;
  const auto place_W = [&before](const Vector3d& p_F) -> Vector3d {
    return before.p_WF + before.R_WF * p_F;
  };
  Vector3d force_W = mass * world.gravity_W + before.R_WF * pushes.force_F;
  Vector3d torque_W = place_W(before.p_FCcm_F).cross(mass * world.gravity_W) +
                      place_W(pushes.point_F).cross(before.R_WF * pushes.force_F) +
                      before.R_WF * pushes.torque_F;
  for (std::size_t i = 0; i < rotors; ++i) {
    const Vector3d f_W = before.R_WF * pushes.rotor_forces_F[i];
    force_W += f_W;
    torque_W += place_W(before.rotors[i].p_FRcm_F).cross(f_W);
  }
  CHECK(((b.linear - a.linear) / dt - force_W).norm() < 1e-4);
  CHECK(((b.angular - a.angular) / dt - torque_W).norm() < 1e-4);

  for (std::size_t i = 0; i < rotors; ++i) {
    CAPTURE(i);
    // About the hinge's axis, where nothing but the joint's torque acts; what a rotor that hangs on
    // this one does to it is left out by asking only those that carry none.
    bool carries = false;
    for (const Joint& joint : flown.joints) carries = carries || joint.parent == i + 1;
    if (carries) continue;
    const RotorKinematics& rotor = before.rotors[i];
    const Vector3d axis_W = before.R_WF * rotor.axis_F;
    const Vector3d arm_W = before.R_WF * before.R_FR(i) * flown.links[i + 1].inertial.pose.xyz;
    const Vector3d f_W = before.R_WF * pushes.rotor_forces_F[i];
    const Vector3d pull_W = (b.linear_of_rotor[i] - a.linear_of_rotor[i]) / dt -
                            flown.links[i + 1].inertial.mass * world.gravity_W - f_W;
    const Vector3d spin_W = (b.spin_of_rotor[i] - a.spin_of_rotor[i]) / dt;
    const double torque = pushes.joint_torques[i] - flown.joints[i].damping * rotor.rate -
                          std::copysign(flown.joints[i].friction, rotor.rate);
    CHECK(axis_W.dot(spin_W + arm_W.cross(pull_W)) == doctest::Approx(torque).epsilon(1e-3));
  }
}

}  // namespace

TEST_CASE("momentum is balanced, of the whole and of each rotor about its axis") {
  World world;
  world.gravity_W = {0.7, -0.4, -9.6};
  for (const EngineInfo& info : engines()) {
    CAPTURE(info.name);
    check_balances(info.name, lopsided(false), world);
    check_balances(info.name, lopsided(false, 0, 11), world);
    if (info.name != "eigen") check_balances(info.name, lopsided(true, 0.002), world);
  }
}

TEST_CASE("momentum is balanced by Gazebo's iterating solver too") {
  World world;
  world.gravity_W = {0.7, -0.4, -9.6};
  world.solver_iterations = 400;
  world.solver_sor = 1.2;
  for (const char* engine : {"gazebo11", "ode"}) {
    CAPTURE(engine);
    for (const bool skew : {false, true}) check_balances(engine, lopsided(skew, 0.002), world);
  }
}

TEST_CASE("a step of eigen is the classical fourth order of Runge and Kutta") {
  // Drag -c v on a ball: a step multiplies by the exponential's series, cut after the fourth power.
  struct Drag final : ForceField {
    void evaluate(Kinematics& k, Loads& loads) const override {
      loads.add_frame_force(0, -2.0 * k.v_WF_F, Vector3d::Zero());
    }
  };
  World world;
  world.gravity_W.setZero();
  const auto engine = make_engine("eigen", model(link("ball", 4, round_body)), world);
  VehicleState state;
  state.linear_velocity = {1, -2, 3};
  engine->set_state(state);
  constexpr double dt = 0.5, z = 2.0 / 4 * dt;
  engine->step(0, dt, Drag());
  engine->get_state(state);
  const Vector3d v(1, -2, 3);
  CHECK((state.linear_velocity - (1 - z + z * z / 2 - z * z * z / 6 + z * z * z * z / 24) * v)
            .norm() < 1e-15);
  CHECK((state.position - dt * (1 - z / 2 + z * z / 6 - z * z * z / 24) * v).norm() < 1e-15);
}
