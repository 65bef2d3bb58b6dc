#include <memory>

#include "lopsided.hpp"
#include "ode/hinged_vehicle.hpp"
#include "ode/ode_math.hpp"
#include "ode/ode_process.hpp"
#include "ode/ode_vehicle.hpp"
#include "quadcore/plugin/random.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

const Vector3d gravity_W{0.3, -0.2, -9.7};

/// A vehicle in a world of its own, away from any engine, whose hinges are a little off.
struct Thrown {
  Bodies bodies;
  std::unique_ptr<dxWorld, void (*)(dWorldID)> world;
  OdeVehicle vehicle;

  Thrown(const Bodies& thrown, double erp, double cfm)
      : bodies(thrown), world(create(erp, cfm)), vehicle(bodies, world.get()) {
    double count = 0;
    const auto draw = [&count] { return random_normal(5, count); };
    VehicleState state;
    for (int i = 0; i < 4; ++i) state.orientation.coeffs()[i] = draw();
    for (int i = 0; i < 3; ++i) {
      state.linear_velocity[i] = 3 * draw();
      state.angular_velocity[i] = 2 * draw();
    }
    const auto n = static_cast<Eigen::Index>(vehicle.rotors());
    state.rotor_velocity = state.rotor_angle = VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      state.rotor_velocity[i] = 40 * draw();
      state.rotor_angle[i] = draw();
    }
    vehicle.place(state);
    for (const dBodyID body : vehicle.bodies()) {
      const Vector3d p = vec(dBodyGetPosition(body)) + 1e-5 * Vector3d(draw(), draw(), draw());
      dBodySetPosition(body, p.x(), p.y(), p.z());
      const Vector3d w = vec(dBodyGetAngularVel(body)) + 1e-3 * Vector3d(draw(), draw(), draw());
      dBodySetAngularVel(body, w.x(), w.y(), w.z());
    }
  }

  static std::unique_ptr<dxWorld, void (*)(dWorldID)> create(double erp, double cfm) {
    start_ode();
    const dWorldID world = dWorldCreate();
    dWorldSetGravity(world, gravity_W.x(), gravity_W.y(), gravity_W.z());
    dWorldSetERP(world, erp);
    dWorldSetCFM(world, cfm);
    return {world, &dWorldDestroy};
  }

  /// Of the bodies on hinges.
  std::vector<Matrix3d> rotations() const {
    std::vector<Matrix3d> all;
    for (std::size_t i = 0; i < vehicle.hinges(); ++i) {
      all.push_back(rotation(dBodyGetRotation(vehicle.bodies()[i + 1])));
    }
    return all;
  }

  /// The same for everybody who counts alike.
  void push(double& count) {
    const auto draw = [&count] { return random_normal(7, count); };
    for (const dBodyID body : vehicle.bodies()) {
      dBodyAddForce(body, draw(), draw(), 3 + draw());
      dBodyAddTorque(body, 1e-3 * draw(), 1e-3 * draw(), 1e-3 * draw());
    }
  }
};

/// Largest difference of what the bodies hold.
double distance(const Thrown& a, const Thrown& b, const dReal* (*get)(dBodyID)) {
  double largest = 0;
  for (std::size_t i = 0; i < a.vehicle.bodies().size(); ++i) {
    const Vector3d apart = vec(get(a.vehicle.bodies()[i])) - vec(get(b.vehicle.bodies()[i]));
    largest = std::max(largest, apart.norm());
  }
  return largest;
}

void check_alike(const GazeboStep::Multipliers& a, const GazeboStep::Multipliers& b) {
  for (std::size_t row = 0; row < a.size(); ++row) {
    CAPTURE(row);
    CHECK(std::abs(a[row] - b[row]) < 1e-9);
  }
}

/// Of two seconds.
void check_against_ode(const Bodies& bodies, double erp, double cfm, double dt) {
  Thrown direct(bodies, erp, cfm), found(bodies, erp, cfm);
  direct.vehicle.report_hinge_forces();
  World world;
  world.gravity_W = gravity_W;
  world.erp = erp;
  world.cfm = cfm;
  HingedVehicle hinged(bodies, world, dInfinity);
  double count = 0, again = 0;
  const std::vector<Matrix3d> R_WC = direct.rotations();
  for (int n = 0; n * dt < 2; ++n) {
    direct.push(count);
    found.push(again);
    dWorldStep(direct.world.get(), dt);
    hinged.take(found.vehicle.bodies());
    hinged.take_forces(found.vehicle.bodies());
    hinged.advance(dt, false);
    hinged.give(found.vehicle.bodies());
    if (n > 0) continue;
    CHECK(distance(direct, found, &dBodyGetLinearVel) < 1e-12);
    CHECK(distance(direct, found, &dBodyGetAngularVel) < 1e-10);
    hinged.for_each_hinge([&](std::size_t i, const GazeboStep::Multipliers& multipliers) {
      check_alike(multipliers, direct.vehicle.multipliers(i, R_WC[i]));
    });
  }
  CHECK(distance(direct, found, &dBodyGetPosition) < 2e-12);
  CHECK(distance(direct, found, &dBodyGetLinearVel) < 1e-10);
}

}  // namespace

TEST_CASE("bodies on hinges move as by ODE's direct solver") {
  check_against_ode(Bodies(lopsided(false)), 0.2, 0, 1e-3);
  // A rotor on a rotor, centres off the axes.
  check_against_ode(Bodies(lopsided(true)), 0.2, 0, 1e-3);
  check_against_ode(Bodies(hexarotor()), 0.3, 0, 5e-4);
}

namespace {

void check_motors_against_ode(const Bodies& bodies) {
  const double dt = 1e-3;
  Thrown direct(bodies, 0.2, 0), found(bodies, 0.2, 0);
  direct.vehicle.report_hinge_forces();
  World world;
  world.gravity_W = gravity_W;
  HingedVehicle hinged(bodies, world, dInfinity);
  hinged.take(found.vehicle.bodies());
  Kinematics k(bodies.rotors.size(), true);
  hinged.show(k);
  Loads loads(bodies.rotors.size());
  for (std::size_t i = 0; i < bodies.rotors.size(); ++i) {
    loads.add_joint_torque(i, i % 2 ? 2.0 : -3.0);
    loads.add_rotor_force(0, i, {0.1, -0.2, 3.0 + static_cast<double>(i)});
  }
  const std::vector<Matrix3d> R_WC = direct.rotations();
  hinged.push(loads);
  hinged.advance(dt, false);
  direct.vehicle.apply(loads, k, dt);
  dWorldStep(direct.world.get(), dt);
  hinged.for_each_hinge([&](std::size_t i, const GazeboStep::Multipliers& multipliers) {
    check_alike(multipliers, direct.vehicle.multipliers(i, R_WC[i]));
  });
}

}  // namespace

TEST_CASE("what hinges exerted under the torques of motors is what ODE's did") {
  check_motors_against_ode(Bodies(lopsided(true)));
  check_motors_against_ode(Bodies(lopsided(true), {0, 2}));  // a rotor on a locked body
}

TEST_CASE("bodies on hinges give way at their hinges as cfm asks") {
  check_against_ode(Bodies(lopsided(true)), 0.2, 1e-4, 1e-3);
  check_against_ode(Bodies(lopsided(false)), 0.4, 1e-7, 2e-3);
}

TEST_CASE("bodies on hinges are braked implicitly as ODE's stops brake") {
  for (const double cfm : {0.0, 1e-5}) {
    Model model = lopsided(true);
    for (Joint& joint : model.joints) joint.implicit_damping = true;
    check_against_ode(Bodies(model), 0.2, cfm, 1e-3);
  }
}

TEST_CASE("locked bodies keep their angles as ODE's stops hold them") {
  // The last joint is on the second: locked on a rotor, and a rotor on a locked body.
  for (const std::vector<std::size_t>& rotors : {std::vector<std::size_t>{1}, {0, 2}, {}}) {
    for (const double cfm : {0.0, 1e-5}) {
      check_against_ode(Bodies(lopsided(true), rotors), 0.2, cfm, 1e-3);
    }
  }
}
