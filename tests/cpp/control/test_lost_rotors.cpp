#include <cmath>
#include <vector>

#include "../plugin_bench.hpp"
#include "modelled_vehicles.hpp"
#include "quadcore/control/actuation.hpp"
#include "reachable.hpp"

using namespace quadcore;
using namespace quadcore::control;

namespace {

using test::Reachable;

/// The vehicle that is left.
ModelledVehicle what_is_left(ModelledVehicle model, const std::vector<double>& lost) {
  for (std::size_t i = 0; i < lost.size(); ++i) {
    model.effectiveness.col(static_cast<Eigen::Index>(i)) *= 1 - lost[i];
  }
  return model;
}

/// Rotors around a regular polygon, the first at +x.
ModelledVehicle regular(const std::vector<double>& spins) {
  ModelledVehicle model = test::odd_belief(static_cast<int>(spins.size()));
  for (std::size_t i = 0; i < spins.size(); ++i) {
    const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(spins.size());
    const Vector3d p(0.2 * std::cos(angle), 0.2 * std::sin(angle), 0), up(0, 0, 1.1e-5);
    model.effectiveness.col(static_cast<Eigen::Index>(i)) << up,
        p.cross(up) - spins[i] * Vector3d(0, 0, 2e-7);
  }
  return model;
}

constexpr double fastest = 700;

}  // namespace

TEST_CASE("what is left of the rotors meets what it can: roll and pitch, thrust, yaw") {
  for (const int n : {5, 6, 8}) {
    const ModelledVehicle model = test::odd_belief(n, fastest);
    const Allocation allocation(model);
    test::Draw draw{static_cast<std::uint64_t>(n)};
    int met = 0, saturated = 0;
    for (int trial = 0; trial < 60; ++trial) {
      std::vector<double> lost(static_cast<std::size_t>(n), 0);
      lost[static_cast<std::size_t>(trial % n)] = trial % 3 == 0 ? 1 : 0.4;
      const ModelledVehicle left = what_is_left(model, lost);
      const Reachable reachable(left, fastest);
      const double thrust = 13 + 8 * draw.number(), size = trial % 2 == 0 ? 1 : 0.2;
      const Vector3d torque = size * Vector3d(draw.number(), draw.number(), 0.1 * draw.number());
      VectorXd squares(n);
      const bool is_met = allocation.allocate({thrust, torque}, squares.data(), lost.data());
      CHECK(squares.minCoeff() >= 0);
      CHECK(squares.maxCoeff() <= fastest * fastest);
      const Eigen::Vector4d got = left.effectiveness.bottomRows<4>() * squares;
      const Demand exerted = allocation.exerted(squares.data(), lost.data());
      CHECK((got.tail<3>() - exerted.torque_F).norm() < 1e-12);
      CHECK(got[0] == doctest::Approx(exerted.thrust).epsilon(1e-12));

      const Eigen::Vector4d up = Eigen::Vector4d::UnitX(), turn = Eigen::Vector4d::UnitW();
      const Eigen::Vector4d level(0, torque.x(), torque.y(), 0);
      const double share = reachable.over(Eigen::Vector4d::Zero(), {level, up, turn}, 1);
      REQUIRE(share >= 0);
      const Eigen::Vector4d tilted = share * level;
      const double most = reachable.over(tilted, {up, turn}, 1e3);
      const double least = -reachable.over(tilted, {-up, turn}, 1e3);
      const Eigen::Vector4d lifted =
          tilted + std::max(least, std::min(thrust, most)) * Eigen::Vector4d::UnitX();
      const double left_turn = reachable.along(lifted, turn);
      const double right_turn = -reachable.along(lifted, -turn);
      const Eigen::Vector4d expected =
          lifted + std::max(right_turn, std::min(torque.z(), left_turn)) * turn;
      CHECK((got - expected).norm() < 1e-6);
      CHECK(is_met == ((got - expected).norm() < 1e-6 && share == doctest::Approx(1) &&
                       std::abs(got[0] - thrust) < 1e-9));
      ++(is_met ? met : saturated);
    }
    CHECK(met > 10);
    CHECK(saturated > 5);
  }
}

TEST_CASE("a hexarotor keeps yaw without one of some rotors, if neighbours turn alike") {
  const double weight = 14;
  const auto keeps = [weight](const std::vector<double>& spins, std::size_t gone) {
    const Allocation allocation(regular(spins));
    std::vector<double> lost(spins.size(), 0);
    lost[gone] = 1;
    return allocation.can_control_yaw(weight, lost.data());
  };
  for (std::size_t gone = 0; gone < 6; ++gone) {
    CHECK(!keeps({1, -1, 1, -1, 1, -1}, gone));
    CHECK(keeps({1, 1, -1, -1, 1, -1}, gone) == (gone < 4));
  }
  for (std::size_t gone = 0; gone < 4; ++gone) CHECK(!keeps({1, -1, 1, -1}, gone));
  for (std::size_t gone = 0; gone < 8; ++gone) CHECK(keeps({1, -1, 1, -1, 1, -1, 1, -1}, gone));
}

TEST_CASE("a rotor that is reported as whole again is commanded as before, a lost one to rest") {
  const Actuation actuation(test::odd_belief(6), {});
  std::vector<double> health(Actuation::state_size(6)), plain = health;
  VectorXd speeds(6), same(6);
  const Demand demand{13, {0.1, -0.05, 0.01}};
  const auto command = [&](std::vector<double>& state, VectorXd& into) {
    actuation.command(0.002, demand, state.data(), into.data());
  };
  actuation.set_remaining(2, 0.3, health.data());
  actuation.set_remaining(2, 1, health.data());
  command(health, speeds);
  command(plain, same);
  CHECK(speeds == same);
  actuation.set_remaining(2, 0, health.data());
  command(health, speeds);
  CHECK(speeds[2] == 0);
  for (int call = 0; call < 500; ++call) command(health, speeds);  // the others take over
  CHECK(speeds[2] == 0);
  CHECK(!Actuation::saturated(health.data()));
  CHECK(actuation.now(health.data()).exerted.thrust == doctest::Approx(13));
}
