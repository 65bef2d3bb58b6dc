#include <algorithm>
#include <cmath>
#include <vector>

#include "../plugin_bench.hpp"
#include "modelled_vehicles.hpp"
#include "quadcore/control/allocation.hpp"
#include "reachable.hpp"

using namespace quadcore;
using namespace quadcore::control;

namespace {

/// What the squares exert, rotor by rotor.
Eigen::Vector4d sum(const ModelledVehicle& model, const VectorXd& squares) {
  Eigen::Vector4d total = Eigen::Vector4d::Zero();
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    total += squares[i] * model.effectiveness.col(i).tail<4>();
  }
  return total;
}

using test::Reachable;

}  // namespace

TEST_CASE("a demand that fits is met with the least squares") {
  for (const int n : {4, 5, 6, 8}) {
    const ModelledVehicle model = test::odd_belief(n);
    const Allocation allocation(model);
    test::Draw draw{static_cast<std::uint64_t>(n)};
    for (int trial = 0; trial < 50; ++trial) {
      const Demand demand{13 + draw.number(), 0.1 * draw.vector()};
      VectorXd squares(n);
      if (!allocation.allocate(demand, squares.data())) continue;
      const Eigen::Vector4d wanted(demand.thrust, demand.torque_F.x(), demand.torque_F.y(),
                                   demand.torque_F.z());
      if ((Reachable(model, 1).inverse * wanted).minCoeff() < 0) continue;  // see below
      const Eigen::Vector4d got = sum(model, squares);
      CHECK(got[0] == doctest::Approx(demand.thrust).epsilon(1e-12));
      CHECK((got.tail<3>() - demand.torque_F).norm() < 1e-12);
      // Least: across everything that exerts nothing.
      const Eigen::MatrixXd B = model.effectiveness.bottomRows<4>();
      const Eigen::MatrixXd nothing = Eigen::FullPivLU<Eigen::MatrixXd>(B).kernel();
      if (n > 4) CHECK((nothing.transpose() * squares).norm() < 1e-7 * squares.norm());
    }
  }
}

TEST_CASE("a demand that does not fit keeps roll and pitch, then thrust, then yaw") {
  for (const int n : {4, 5, 6}) {
    const ModelledVehicle model = test::odd_belief(n, 700);
    const Allocation allocation(model);
    const Reachable reachable(model, 700);
    const Eigen::Vector4d up = Eigen::Vector4d::UnitX();
    test::Draw draw{7};
    int saturated = 0, freed = 0;
    for (int trial = 0; trial < 100; ++trial) {
      const double thrust = 13 + 12 * draw.number();
      const double size = trial % 2 == 0 ? 3 : 0.7;
      const Vector3d torque = size * Vector3d(draw.number(), draw.number(), 0.1 * draw.number());
      VectorXd squares(n);
      const bool met = allocation.allocate({thrust, torque}, squares.data());
      CHECK(squares.minCoeff() >= 0);
      CHECK(squares.maxCoeff() <= 700.0 * 700.0);
      const Eigen::Vector4d got = sum(model, squares);
      const Eigen::Vector4d level(0, torque.x(), torque.y(), 0), yaw(0, 0, 0, torque.z());
      const double share = reachable.over(Eigen::Vector4d::Zero(), {level, up}, 1);
      REQUIRE(share >= 0);
      const double most = reachable.along(share * level, up);
      const double least = -reachable.along(share * level, -up);
      const double best = std::max(least, std::min(thrust, most));
      const double turned = std::max(0.0, reachable.along(share * level + best * up, yaw, 1));
      // What can be exerted as a whole is, even if it could not be without its yaw.
      const Eigen::Vector4d whole = level + thrust * up + yaw;
      const bool fits = reachable.along(whole, up) >= 0 && reachable.along(whole, -up) >= 0;
      const Eigen::Vector4d expected = fits ? whole : (share * level + best * up + turned * yaw);
      CHECK((got - expected).norm() < 1e-6);
      CHECK(met == ((got - up * thrust - level - yaw).norm() < 1e-9));
      if (!met) ++saturated;
      const VectorXd least_norm = reachable.inverse * (up * thrust + level + yaw);
      if (met && (least_norm.minCoeff() < 0 || least_norm.maxCoeff() > 1)) {
        ++freed;
        // Nothing else near that exerts it has smaller squares.
        const VectorXd u = squares / (700.0 * 700.0);
        test::Draw way{3};
        for (int other = 0; other < 50; ++other) {
          VectorXd change = VectorXd::Zero(n);
          for (Eigen::Index k = 0; k < reachable.freedom.cols(); ++k) {
            change += 0.01 * way.number() * reachable.freedom.col(k);
          }
          const VectorXd beside = u + change;
          if (beside.minCoeff() < 0 || beside.maxCoeff() > 1) continue;
          CHECK(beside.norm() >= u.norm() - 1e-9);
        }
      }
    }
    CHECK(saturated > 10);
    if (n > 4) CHECK(freed > 0);
  }
}

TEST_CASE("more rotors than needed meet every demand that some speeds meet") {
  for (const int n : {5, 6, 8, 12}) {
    const ModelledVehicle model = test::odd_belief(n, 700);
    const Allocation allocation(model);
    test::Draw draw{static_cast<std::uint64_t>(n)};
    for (int trial = 0; trial < 2000; ++trial) {
      VectorXd some(n), squares(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        some[i] = 700.0 * 700.0 * std::clamp(0.5 + 0.8 * draw.number(), 0.0, 1.0);
      }
      const Demand demand = allocation.exerted(some.data());
      allocation.allocate(demand, squares.data());
      const Demand got = allocation.exerted(squares.data());
      CHECK(std::abs(got.thrust - demand.thrust) < 1e-8);
      CHECK((got.torque_F - demand.torque_F).norm() < 1e-8);
    }
  }
}

TEST_CASE("rotors that cannot turn the vehicle about an axis are refused") {
  ModelledVehicle model = test::odd_belief(4);
  for (ModelledRotor& rotor : model.rotors) rotor.spin = 1;
  model.effectiveness.row(5).setZero();
  CHECK(test::contains(test::refusal([&] { Allocation{model}; }), "independently"));
  CHECK(test::contains(test::refusal([] { Allocation{test::odd_belief(3)}; }), "independently"));
}

TEST_CASE("it does not matter where in memory the numbers lie") {
  for (const int n : {4, 5, 6, 8}) {
    const Allocation allocation(test::odd_belief(n, 700));
    test::Draw draw{11};
    std::vector<double> here(20), there(20);
    for (int trial = 0; trial < 200; ++trial) {
      const Demand demand{13 + 6 * draw.number(), draw.vector()};
      allocation.allocate(demand, here.data());
      allocation.allocate(demand, there.data() + 1);
      CHECK(std::equal(here.begin(), here.begin() + n, there.begin() + 1));
      const Demand one = allocation.exerted(here.data()), other = allocation.exerted(&there[1]);
      CHECK(one.thrust == other.thrust);
      CHECK(one.torque_F == other.torque_F);
    }
  }
}
