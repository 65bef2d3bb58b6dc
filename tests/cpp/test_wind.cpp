#include <cmath>
#include <complex>

#include "vehicle.hpp"
#include "wind/dryden.hpp"

using namespace quadcore;
using namespace quadcore::wind;

namespace {

constexpr double foot = 0.3048;

/// What a step makes of a state without noise, and the covariance of the noise it adds.
struct Discretised {
  Eigen::Matrix2d transition, noise;

  explicit Discretised(const TransverseFilter& f) {
    const Eigen::Matrix2d root = (Eigen::Matrix2d() << f.xx, 0, f.xy, f.yy).finished();
    transition << f.decay, 0, f.carry, f.decay;
    noise = root * root.transpose();
  }
};

const Eigen::Matrix2d stationary = (Eigen::Matrix2d() << 0.5, 0.25, 0.25, 0.25).finished();

}  // namespace

TEST_CASE("lengths and deviations of turbulence are those of the specification") {
  struct {
    double feet, length, ratio;
  } const table[] = {{20, 143.589, 1.92914},
                     {50, 310.788, 1.83865},
                     {100, 505.169, 1.71585},
                     {500, 944.657, 1.23624}};
  for (const auto& row : table) {
    const DrydenScales scales = low_altitude(row.feet * foot, 20);
    CHECK(std::abs(scales.length_uv / foot - row.length) < 5e-4);
    CHECK(scales.length_w == row.feet * foot);
    CHECK(std::abs(scales.sigma_uv / scales.sigma_w - row.ratio) < 5e-6);
    CHECK(scales.sigma_w == doctest::Approx(2).epsilon(1e-15));
  }
  const DrydenScales scales = low_altitude(10, 1);
  CHECK(std::abs(scales.length_uv - 67.365951) < 5e-7);
  CHECK(std::abs(scales.sigma_uv / scales.sigma_w - 1.888630) < 5e-7);
}

TEST_CASE("a step of a filter leaves its stationary covariance, whatever its length") {
  for (const double dt : {1e-9, 1e-6, 1e-3, 0.1, 1.0, 10.0, 100.0, 1e6}) {
    CAPTURE(dt);
    const Discretised step(TransverseFilter::of(30, 5, dt));
    const Eigen::Matrix2d after =
        step.transition * stationary * step.transition.transpose() + step.noise;
    CHECK((after - stationary).norm() < 1e-15);
    const auto lag = LongitudinalFilter::of(30, 5, dt);
    CHECK(lag.decay * lag.decay + lag.kick * lag.kick == doctest::Approx(1).epsilon(1e-15));
  }
}

TEST_CASE("two steps of a filter are one of twice the length, to the last digits of its noise") {
  for (const double dt : {1e-6, 1e-3, 0.1, 1.0, 10.0}) {
    CAPTURE(dt);
    const Discretised one(TransverseFilter::of(30, 5, dt)),
        two(TransverseFilter::of(30, 5, 2 * dt));
    CHECK((one.transition * one.transition - two.transition).norm() < 1e-15);
    const Eigen::Matrix2d twice =
        one.transition * one.noise * one.transition.transpose() + one.noise;
    for (int i = 0; i < 4; ++i) {
      CHECK(twice(i) == doctest::Approx(two.noise(i)).epsilon(1e-13));
    }
    // What the second state gets that the first does not tell is the smallest of it.
    const auto unexplained = [](const Eigen::Matrix2d& m) {
      return m(1, 1) - m(0, 1) * m(0, 1) / m(0, 0);
    };
    CHECK(unexplained(twice) / unexplained(two.noise) == doctest::Approx(1).epsilon(1e-12));
  }
}

TEST_CASE("a filter lets white noise through as the specification's spectrum says") {
  // Its transfer function, at steps that are short, from the response to one kick.
  const double length = 30, airspeed = 5, dt = 1e-3, a = airspeed / length;
  const Discretised step(TransverseFilter::of(length, airspeed, dt));
  for (const double w : {0.1 * a, a, 3 * a, 10 * a}) {
    const std::complex<double> z = std::polar(1.0, w * dt);
    const Eigen::Matrix2cd resolvent =
        (z * Eigen::Matrix2cd::Identity() - step.transition.cast<std::complex<double>>()).inverse();
    const Eigen::RowVector2cd out(std::sqrt(3.0), 1 - std::sqrt(3.0));
    const double density = (out * resolvent * step.noise.cast<std::complex<double>>() *
                            resolvent.adjoint() * out.adjoint())(0)
                               .real() *
                           dt / M_PI;
    const double x = length * w / airspeed;
    const double phi = length / (M_PI * airspeed) * (1 + 3 * x * x) / std::pow(1 + x * x, 2);
    CHECK(density == doctest::Approx(phi).epsilon(1e-5));
  }
}

TEST_CASE("turbulence without any mean wind has its u along x") {
  Turbulence turbulence{};
  turbulence.begin(low_altitude(10, 15), Vector3d(0, 0, -3), 2, 1e-3, 7);
  CHECK(turbulence.along_x == 1);
  CHECK(turbulence.along_y == 0);
  CHECK(turbulence.u.decay == std::exp(-3 / low_altitude(10, 15).length_uv * 1e-3));
}
