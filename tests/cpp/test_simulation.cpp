#include <cmath>

#include "vehicle.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

/// A hexarotor that nothing pushes, in steps so short that it keeps the motion it is given.
Simulation still(const std::string& engine, double dt = 1e-9, bool has_plugins = false) {
  Model model = hexarotor();
  if (!has_plugins) model.plugins.clear();
  World world;
  world.gravity_W.setZero();
  SimulationOptions options;
  options.engine = engine;
  options.dt = dt;
  return Simulation(model, world, options);
}

}  // namespace

TEST_CASE("a snapshot is restored by a simulation of the same engine and step only") {
  for (const EngineInfo& info : engines()) {
    CAPTURE(info.name);
    Simulation flown = still(info.name, 1e-3);
    const Snapshot snapshot = flown.snapshot();
    still(info.name, 1e-3).restore(snapshot);
    Simulation finer = still(info.name, 5e-4);
    CHECK(contains(refusal([&] { finer.restore(snapshot); }),
                   "snapshot: it was taken with a different step ('0.001' there, '0.0005' here)"));
    for (const EngineInfo& other : engines()) {
      if (other.name == info.name) continue;
      Simulation elsewhere = still(other.name, 1e-3);
      CHECK(contains(refusal([&] { elsewhere.restore(snapshot); }),
                     "a different engine ('" + info.name + "' there, '" + other.name + "' here)"));
    }
  }
}

TEST_CASE("another world is taken on purpose, another model never") {
  Model model = hexarotor();
  model.plugins.clear();
  World world;
  const Snapshot snapshot = Simulation(model, world, {}).snapshot();
  world.wind_W.x() = 2.5;
  Simulation windy(model, world, {});
  CHECK(refusal([&] { windy.restore(snapshot); }) ==
        "snapshot: it was taken with a different world ('wind 0 0 0' there, 'wind 2.5 0 0' here). "
        "Restore a snapshot of this simulation, or allow world to differ.");
  windy.restore(snapshot, Allowed::of({"world"}));
  CHECK(contains(refusal([] { Allowed::of({"model"}); }),
                 "may not differ. Choose from: world, parameters."));
  model.links[2].inertial.mass *= 1.5;
  Simulation heavier(model, world, {});
  const std::string message =
      refusal([&] { heavier.restore(snapshot, Allowed::of({"world", "parameters"})); });
  CHECK(contains(message, "a different model ('link " + model.links[2].name + " mass "));
  CHECK(!contains(message, "world"));
}

TEST_CASE("a flight ends where a speed, a rate or a distance is beyond all that is meant") {
  // Each number of a state, which a step in one engine takes to `value`.
  const auto outcome = [](const std::string& engine, auto member, double value) -> std::string {
    Simulation flown = still(engine, 1e-9, true);  // motors take the command of a motion
    flown.move_by([&](double, const VectorXd&, VehicleState& state) { member(state) = value; });
    try {
      flown.step();
    } catch (const FlightError& error) {
      return error.what();
    }
    return "";
  };
  const auto check = [&](const std::string& engine, auto member, double bound) {
    for (const double sign : {1.0, -1.0}) {
      CHECK(outcome(engine, member, sign * 0.9 * bound) == "");
      CHECK(contains(outcome(engine, member, sign * 1.1 * bound), "the motion diverged"));
      Simulation set = still(engine);
      VehicleState state = set.state();
      member(state) = sign * 0.9 * bound;
      set.set_state(state);
      set.step();
      member(state) = sign * 1.1 * bound;
      CHECK(contains(refusal([&] { set.set_state(state); }), "a flight counts as diverged from"));
    }
  };
  for (const EngineInfo& info : engines()) {
    CAPTURE(info.name);
    for (int i = 0; i < 3; ++i) {
      check(info.name, [i](VehicleState& s) -> double& { return s.position[i]; }, 1e9);
      check(info.name, [i](VehicleState& s) -> double& { return s.linear_velocity[i]; }, 1e6);
    }
    for (int i = 0; i < 6; ++i) {
      check(info.name, [i](VehicleState& s) -> double& { return s.rotor_velocity[i]; }, 1e6);
    }
  }
  // Of a body that turns so fast about a skew axis, only the exact engine keeps the rate.
  for (int i = 0; i < 3; ++i) {
    check("eigen", [i](VehicleState& s) -> double& { return s.angular_velocity[i]; }, 1e6);
  }
}

TEST_CASE(
    "state and summed joint rates are the same, requested after each step or once at the end") {
  const std::vector<double> command = {700, -650, 700, -700, 650, -700};
  for (const EngineInfo& info : engines()) {
    CAPTURE(info.name);
    Simulation often = still(info.name, 1e-3, true), once = still(info.name, 1e-3, true);
    std::vector<double> last(6, 0.0), sums(6, 0.0);
    TotalVariation rates(6);
    rates.add(last.data());
    once.command(command.data(), command.size());
    often.command(command.data(), command.size());
    once.step(50, &rates);
    for (int step = 0; step < 50; ++step) {
      often.step();
      for (std::size_t i = 0; i < 6; ++i) {
        const double size = std::abs(often.state().rotor_velocity[static_cast<Eigen::Index>(i)]);
        sums[i] += std::abs(size - last[i]);
        last[i] = size;
      }
    }
    CHECK(rates.sums() == sums);
    CHECK(sums.front() > 0);
    CHECK(once.state().time == often.time());
    CHECK(once.state().position == often.state().position);
    CHECK(once.state().linear_velocity == often.state().linear_velocity);
    CHECK(once.state().rotor_velocity == often.state().rotor_velocity);
    CHECK(once.state().rotor_angle == often.state().rotor_angle);
  }
}
