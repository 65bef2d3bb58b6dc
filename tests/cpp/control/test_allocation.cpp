#include <algorithm>
#include <cmath>
#include <vector>

#include "../plugin_bench.hpp"
#include "beliefs.hpp"
#include "quadcore/control/allocation.hpp"

using namespace quadcore;
using namespace quadcore::control;

namespace {

/// What the squares exert, rotor by rotor.
Eigen::Vector4d sum(const Belief& belief, const VectorXd& squares) {
  Eigen::Vector4d total = Eigen::Vector4d::Zero();
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    total += squares[i] * belief.effectiveness.col(i).tail<4>();
  }
  return total;
}

}  // namespace

TEST_CASE("a demand that fits is met with the least squares") {
  for (const int n : {4, 5, 6, 8}) {
    const Belief belief = test::odd_belief(n);
    const Allocation allocation(belief);
    test::Draw draw{static_cast<std::uint64_t>(n)};
    for (int trial = 0; trial < 50; ++trial) {
      const Demand demand{13 + draw.number(), 0.1 * draw.vector()};
      VectorXd squares(n);
      if (!allocation.allocate(demand, squares.data())) continue;
      const Eigen::Vector4d got = sum(belief, squares);
      CHECK(got[0] == doctest::Approx(demand.thrust).epsilon(1e-12));
      CHECK((got.tail<3>() - demand.torque_F).norm() < 1e-12);
      // Least: across everything that exerts nothing.
      const Eigen::MatrixXd B = belief.effectiveness.bottomRows<4>();
      const Eigen::MatrixXd nothing = Eigen::FullPivLU<Eigen::MatrixXd>(B).kernel();
      if (n > 4) CHECK((nothing.transpose() * squares).norm() < 1e-7 * squares.norm());
    }
  }
}

TEST_CASE("a demand that does not fit keeps roll and pitch, then thrust, then yaw") {
  constexpr int steps = 400;  // of the brute force
  for (const int n : {4, 6}) {
    const Belief belief = test::odd_belief(n, 700);
    const Allocation allocation(belief);
    const Eigen::MatrixXd B = belief.effectiveness.bottomRows<4>();
    const Eigen::MatrixXd inverse = B.transpose() * (B * B.transpose()).inverse();
    const double most = 700.0 * 700.0;
    const auto fits = [&](const VectorXd& u) {
      return u.minCoeff() >= -1e-6 * most && u.maxCoeff() <= (1 + 1e-6) * most;
    };
    test::Draw draw{7};
    int saturated = 0;
    for (int trial = 0; trial < 60; ++trial) {
      const double thrust = 13 + 12 * draw.number();
      const Vector3d torque = 3 * Vector3d(draw.number(), draw.number(), 0.1 * draw.number());
      VectorXd squares(n);
      if (allocation.allocate({thrust, torque}, squares.data())) continue;
      ++saturated;
      CHECK(squares.minCoeff() >= 0);
      CHECK(squares.maxCoeff() <= most);
      const Eigen::Vector4d got = sum(belief, squares);
      // Shares found by trying.
      const auto of = [&](double T, double share, double yaw) -> VectorXd {
        Eigen::Vector4d demand;
        demand << T, share * torque.x(), share * torque.y(), yaw * torque.z();
        return inverse * demand;
      };
      const auto best_thrust = [&](double share) {
        double best = NAN;
        for (int i = 0; i <= 4 * steps; ++i) {
          const double T = 40.0 * i / (4 * steps);
          const bool nearer = !(std::abs(T - thrust) >= std::abs(best - thrust));
          if (nearer && fits(of(T, share, 0))) best = T;
        }
        return best;
      };
      const double share = got.segment<2>(1).dot(torque.head<2>()) / torque.head<2>().squaredNorm();
      double best_share = 0;
      for (int i = 0; i <= 100; ++i) {
        if (!std::isnan(best_thrust(i / 100.0))) best_share = i / 100.0;
      }
      CHECK(share >= best_share - 1e-6);
      CHECK(share <= best_share + 0.0101);
      CHECK((got.segment<2>(1) - share * torque.head<2>()).norm() < 1e-9);
      if (share > 1 - 1e-9) {
        CHECK(got[0] == doctest::Approx(best_thrust(1)).scale(1).epsilon(0.03));
      }
      const double yaw = got[3] / torque.z();
      CHECK(yaw >= -1e-9);
      CHECK(yaw <= 1 + 1e-9);
      if (yaw < 1 - 1e-6) CHECK(!fits(of(got[0], share, yaw + 0.01)));
    }
    CHECK(saturated > 10);
  }
}

TEST_CASE("rotors that cannot turn the vehicle about an axis are refused") {
  Belief belief = test::odd_belief(4);
  for (BelievedRotor& rotor : belief.rotors) rotor.spin = 1;
  belief.effectiveness.row(5).setZero();
  CHECK(test::contains(test::refusal([&] { Allocation{belief}; }), "independently"));
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
