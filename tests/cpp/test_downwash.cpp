#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "downwash/turbulent_jet.hpp"
#include "plugin_bench.hpp"

/// \file
/// The jet below a vehicle, as far as it follows from turbulent jets in general and from symmetry.

namespace quadcore::test {
namespace {

using downwash::TurbulentJet;

constexpr double density = 1.225;  // kg/m^3
constexpr double radius = 0.06;    // m
constexpr double distance = 0.24;  // m, of opposite rotors
constexpr double weight = 9;       // N

/// Hovers level at the origin.
OtherVehicle hovering() {
  OtherVehicle vehicle;
  for (int i = 0; i < 4; ++i) {
    const double x = distance / 2 * (i % 2 == 0 ? 1 : -1);
    vehicle.rotors.push_back(
        {i < 2 ? Vector3d(x, 0, 0) : Vector3d(0, x, 0), {0, 0, weight / 4}, radius});
  }
  return vehicle;
}

TurbulentJet jet_below(const OtherVehicle& vehicle) {
  const auto jet = TurbulentJet::below(vehicle, density);
  REQUIRE(jet);
  return *jet;
}

/// Momentum that flows through a level plane per time, by the trapezoidal rule [N].
double momentum_at(const TurbulentJet& jet, double depth) {
  double sum = 0;
  const double step = 1e-3;
  for (double r = step; r < 40; r += step) {
    const double v = jet.velocity_at({r * 0.6, r * 0.8, -depth}).norm();
    sum += 2 * M_PI * r * density * v * v * step;
  }
  return sum;
}

}  // namespace

TEST_CASE("the momentum of a wake is the same at every distance, and near the thrust") {
  const TurbulentJet jet = jet_below(hovering());
  const double near = momentum_at(jet, 3 * distance);
  CHECK(momentum_at(jet, 8 * distance) == doctest::Approx(near).epsilon(1e-4));
  CHECK(momentum_at(jet, 20 * distance) == doctest::Approx(near).epsilon(1e-4));
  // The fit is one of flights, so that it meets the thrust only about; here l = 4 R.
  CHECK(near == doctest::Approx(weight).epsilon(0.05));
}

TEST_CASE("a wake slows down with the distance and widens") {
  const TurbulentJet jet = jet_below(hovering());
  const double induced = std::sqrt(weight / (8 * density * M_PI * radius * radius));
  const auto speed = [&](double r, double depth) {
    return -jet.velocity_at({r, 0, -depth}).z() / induced;
  };
  CHECK(speed(0, 5 * distance) == doctest::Approx(10.11 / 10.817).epsilon(1e-14));
  CHECK(speed(0, 10 * distance) == doctest::Approx(10.11 / 15.817).epsilon(1e-14));
  for (const double s : {2.5, 5.0, 10.0}) {
    const double half_width = 0.07668 * (s + 5.817) * distance;
    CHECK(speed(half_width, s * distance) ==
          doctest::Approx(speed(0, s * distance) / 2).epsilon(1e-14));
  }
  CHECK(speed(0.1, distance) == doctest::Approx(speed(0.1, 2.5 * distance)).epsilon(1e-14));
  CHECK(speed(0.1, 0.3 * distance) == doctest::Approx(0.3 * speed(0.1, distance)).epsilon(1e-14));
  CHECK(speed(0.5, 1e-9) < 1e-8);  // no step for vehicles side by side
  CHECK(speed(0.1, 0) == 0);
  CHECK(speed(0, -1) == 0);
}

TEST_CASE("a wake turns and moves with its vehicle") {
  Draw draw{3};
  const Quaterniond R = draw.rotation();
  const Vector3d p = draw.vector();
  OtherVehicle turned = hovering();
  for (OtherRotor& rotor : turned.rotors) {
    rotor.p_WRcm_W = p + R * rotor.p_WRcm_W;
    rotor.f_W = R * rotor.f_W;
  }
  const TurbulentJet upright = jet_below(hovering()), jet = jet_below(turned);
  for (int i = 0; i < 20; ++i) {
    const Vector3d point = draw.vector() - Vector3d(0, 0, 1);
    CHECK((jet.velocity_at(p + R * point) - R * upright.velocity_at(point)).norm() < 1e-13);
  }
}

TEST_CASE("only rotors of known radius that exert a force have a wake") {
  OtherVehicle vehicle = hovering();
  vehicle.rotors.push_back({{0.7, 0, 0}, {0, 0, 5}, std::numeric_limits<double>::quiet_NaN()});
  const TurbulentJet jet = jet_below(vehicle);
  CHECK(jet.length == doctest::Approx(distance));
  CHECK(jet.origin_W.norm() < 1e-15);
  for (OtherRotor& rotor : vehicle.rotors) rotor.f_W.setZero();
  CHECK(!TurbulentJet::below(vehicle, density));
  vehicle = hovering();
  for (OtherRotor& rotor : vehicle.rotors) rotor.radius = std::numeric_limits<double>::quiet_NaN();
  CHECK(!TurbulentJet::below(vehicle, density));
}

}  // namespace quadcore::test
