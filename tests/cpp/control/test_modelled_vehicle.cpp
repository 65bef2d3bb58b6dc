#include <cmath>

#include "../plugin_bench.hpp"
#include "quadcore/control/modelled_vehicle.hpp"
#include "quadcore/control/start.hpp"

using namespace quadcore;
using namespace quadcore::control;

namespace {

/// The hexarotor of the recordings: tilted rotors, centre of mass off the origin, friction in some.
VehicleDescription described(const std::string& engine, const std::string& drag_model,
                             const std::string& slow) {
  SimulationOptions options;
  options.engine = engine;
  options.parameters = {{"drone_plugin.dragModel", drag_model},
                        {"drone_plugin.sim_slow", slow},
                        {"motorpid_plugin.sim_slow", slow}};
  if (drag_model == "chapter2") options.parameters["drone_plugin.flappingA1c"] = "0.1";
  Simulation simulation(test::hexarotor(), World{}, options);
  simulation.step(3);
  const Snapshot before = simulation.snapshot();
  const VehicleDescription vehicle = simulation.describe_vehicle();
  CHECK(simulation.snapshot().engine == before.engine);
  return vehicle;
}

}  // namespace

TEST_CASE("the air is described as the force laws have it, whatever the joints' angles") {
  for (const char* engine : {"eigen", "gazebo11"}) {
    for (const bool appendix : {false, true}) {
      const VehicleDescription vehicle = described(engine, appendix ? "appendix" : "chapter2", "2");
      // By hand: each rotor's drag across its axis, at its place; flapping is drag, too.
      double lift = 0;
      for (const RotorDescription& rotor : vehicle.rotors) lift += 1.1487e-5 * rotor.axis_F.z();
      const double hover = std::sqrt(vehicle.body.mass * 9.8 / lift);
      const double c = 0.0175 + (appendix ? 0 : 0.1 * 1.1487e-5 * hover / 0.075);
      Eigen::Matrix<double, 6, 6> expected = Eigen::Matrix<double, 6, 6>::Zero();
      for (const RotorDescription& rotor : vehicle.rotors) {
        const Matrix3d across = Matrix3d::Identity() - rotor.axis_F * rotor.axis_F.transpose();
        const Matrix3d r = skew((appendix ? rotor.p_FR_F : rotor.p_FRcm_F) - vehicle.body.p_FCcm);
        const Matrix3d place = skew(rotor.p_FRcm_F - vehicle.body.p_FCcm);
        expected.topLeftCorner<3, 3>() += c * across;
        expected.topRightCorner<3, 3>() -= c * across * r;
        expected.bottomLeftCorner<3, 3>() += c * place * across;
        expected.bottomRightCorner<3, 3>() -= c * place * across * r;
      }
      // Flapping answers to turning besides, and the hover speeds ignore the rotors' tilt.
      const double bar = appendix ? 1e-9 : 2e-3;
      const auto error = (vehicle.air.linear - expected).eval();
      CHECK(error.leftCols<3>().norm() < bar * expected.leftCols<3>().norm());
      if (appendix) CHECK(error.norm() < 1e-9 * expected.norm());
      CHECK(vehicle.air.quadratic == doctest::Approx(appendix ? 0 : 0.003).scale(0.003));
      const double along_z = 6 * 0.003 * std::cos(0.05235987755982989);
      CHECK(vehicle.air.of_components.z() ==
            doctest::Approx(appendix ? along_z : 0).scale(0.018).epsilon(1e-5));
      CHECK(vehicle.air.of_components.head<2>().norm() < 1e-8);
    }
  }
}

TEST_CASE("drag that the force laws do not have is described as none, without rounding errors") {
  const std::string tags =
      test::tag("rotorThrustCoeff", "1.1487e-5") + test::tag("rotorTorqueCoeff", "1.1e-7") +
      test::tag("inducedDragCoeff", "0.0175") + test::tag("parasiticDragCoeff", "0.003") +
      test::tag("dragModel", "appendix");
  for (const char* engine : {"eigen", "gazebo11"}) {
    Simulation simulation(test::vehicle_with("aerodynamic", tags, 4), World{}, {engine});
    const AirResistance& air = simulation.describe_vehicle().air;
    CHECK(air.quadratic == 0);
    CHECK(air.of_components.z() == doctest::Approx(4 * 0.003));
  }
}

TEST_CASE("a rotor is described as its motor drives it") {
  const VehicleDescription vehicle = described("eigen", "appendix", "4");
  for (const std::size_t i : {0U, 4U}) {
    const RotorDescription& rotor = vehicle.rotors[i];
    const double damping = i == 4 ? 1e-6 : rotor.rate_per_command == 0.25 ? 0 : 1e-6;
    CHECK(rotor.rate_per_command == doctest::Approx(5e-4 / (5e-4 + damping) / 4).epsilon(1e-12));
    CHECK(rotor.lag == doctest::Approx(rotor.moment / (5e-4 + damping)).epsilon(1e-12));
    CHECK(std::isinf(rotor.fastest));
  }
}

TEST_CASE("what a command exerts does not depend on how much slower the rotors turn") {
  const ModelledVehicle one = ModelledVehicle::of(described("eigen", "appendix", "1"), {}, {});
  const ModelledVehicle ten = ModelledVehicle::of(described("eigen", "appendix", "10"), {}, {});
  CHECK((one.effectiveness - ten.effectiveness).norm() < 1e-12 * one.effectiveness.norm());
}

TEST_CASE("neighbours turn against each other unless the spins are given") {
  VehicleDescription vehicle = described("eigen", "appendix", "1");
  const auto spins = [&](const std::vector<double>& given) {
    std::vector<double> all;
    for (const ModelledRotor& r : ModelledVehicle::of(vehicle, given, {}).rotors)
      all.push_back(r.spin);
    return all;
  };
  // Its rotors are tilted so that their thrust helps this sense to yaw, and hinders the other.
  CHECK(spins({}) == std::vector<double>{-1, 1, -1, 1, -1, 1});
  std::swap(vehicle.rotors[1], vehicle.rotors[2]);
  std::swap(vehicle.rotors[1].place, vehicle.rotors[2].place);
  CHECK(spins({}) == std::vector<double>{-1, -1, 1, 1, -1, 1});
  for (RotorDescription& rotor : vehicle.rotors) rotor.backward = rotor.forward;
  CHECK(spins({}) == std::vector<double>{1, 1, -1, -1, 1, -1});
  CHECK(spins({1, 1, 1, -1, -1, -1}) == std::vector<double>{1, 1, 1, -1, -1, -1});
  vehicle.rotors.pop_back();
  CHECK(test::contains(test::refusal([&] { spins({}); }), "Give their spins"));
  vehicle.gravity_W = {1, 0, -9};
  CHECK(test::contains(test::refusal([&] { spins({}); }), "gravity"));
}

TEST_CASE("a modelled factor makes the model wrong by it") {
  const VehicleDescription vehicle = described("eigen", "appendix", "1");
  const ModelledVehicle truth = ModelledVehicle::of(vehicle, {}, {});
  const ModelledVehicle wrong = ModelledVehicle::of(
      vehicle, {}, {{"believed_mass", 1.2}, {"believed_thrust", 0.9}, {"believed_drag", 0.5}});
  CHECK(wrong.mass == doctest::Approx(1.2 * truth.mass));
  CHECK((wrong.effectiveness - 0.9 * truth.effectiveness).norm() < 1e-15);
  CHECK((wrong.air.linear - 0.5 * truth.air.linear).norm() < 1e-15);
  CHECK(wrong.inertia_Ccm_F == truth.inertia_Ccm_F);
}

TEST_CASE("a vehicle that starts on a reference stays on it for a moment") {
  const auto eight = make_reference("eight", {{"yaw_rate", 0.4}});
  Simulation simulation(test::hexarotor(), World{}, {"eigen"});
  VehicleState state = start_on(eight->at(0), simulation.describe_vehicle());
  simulation.set_state(state);
  const VectorXd w = state.rotor_velocity;
  simulation.command(w.data(), 6);
  simulation.step(20);
  const Reference then = eight->at(0.02);
  CHECK((simulation.state().position - then.position).norm() < 2e-5);
  CHECK((simulation.state().linear_velocity - then.velocity).norm() < 3e-3);
}
