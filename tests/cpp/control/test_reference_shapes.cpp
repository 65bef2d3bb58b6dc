#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "../plugin_bench.hpp"
#include "../vehicle.hpp"
#include "derivatives.hpp"
#include "quadcore/control/reference.hpp"

using namespace quadcore;
using namespace quadcore::control;

namespace {

constexpr double pi = M_PI;

/// The waypoints of config/waypoints.yaml.
Rows five_waypoints() {
  Rows rows(6, 4);
  rows << 0, 0, 0, 10, 2.2, 3, 1, 11, 4.2, 4, 4, 12, 6.2, 1, 5, 11, 8.2, -1, 2, 10, 10.4, 0, 0, 10;
  return rows;
}

/// The same path by the equations of all coefficients at once, in plain powers of t.
Eigen::VectorXd dense_minimum_snap(const Rows& rows, int axis, double at) {
  const Eigen::Index pieces = rows.rows() - 1;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(8 * pieces, 8 * pieces);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(8 * pieces);
  const auto powers = [](double t, int derivative) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(8);
    for (int k = derivative; k < 8; ++k) {
      row[k] = std::tgamma(k + 1) / std::tgamma(k - derivative + 1) * std::pow(t, k - derivative);
    }
    return row;
  };
  Eigen::Index equation = 0;
  for (Eigen::Index i = 0; i < pieces; ++i) {
    const double h = rows(i + 1, 0) - rows(i, 0);
    A.block(equation, 8 * i, 1, 8) = powers(0, 0);
    b[equation++] = rows(i, axis + 1);
    A.block(equation, 8 * i, 1, 8) = powers(h, 0);
    b[equation++] = rows(i + 1, axis + 1);
    for (int d = 1; d < 7 && i + 1 < pieces; ++d) {
      A.block(equation, 8 * i, 1, 8) = powers(h, d);
      A.block(equation++, 8 * (i + 1), 1, 8) = -powers(0, d);
    }
  }
  for (int d = 1; d < 4; ++d) {
    A.block(equation++, 0, 1, 8) = powers(0, d);
    const double h = rows(pieces, 0) - rows(pieces - 1, 0);
    A.block(equation++, 8 * (pieces - 1), 1, 8) = powers(h, d);
  }
  REQUIRE(equation == 8 * pieces);
  const Eigen::VectorXd c = A.fullPivLu().solve(b);
  Eigen::Index i = 0;
  while (i + 1 < pieces && at >= rows(i + 1, 0)) ++i;
  Eigen::VectorXd derivatives(5);
  for (int d = 0; d < 5; ++d) {
    derivatives[d] = powers(at - rows(i, 0), d).dot(c.segment(8 * i, 8));
  }
  return derivatives;
}

}  // namespace

TEST_CASE("every derivative of a reference is that of the one before") {
  const Values odd = {{"x", 0.3}, {"y", -0.7}, {"yaw", 0.4}, {"yaw_rate", -0.6}};
  for (const ReferenceInfo& info : references()) {
    CAPTURE(info.name);
    const auto shape = info.takes_rows               ? info.make({}, five_waypoints())
                       : info.name == "takeoff_land" ? make_reference(info.name, {{"yaw", 0.4}})
                                                     : make_reference(info.name, odd);
    for (const double t : {0.41, 1.7, 3.3, 5.02, 7.9, 9.6}) test::check_derivatives(*shape, t);
  }
}

TEST_CASE("yaw points along the velocity with the parameter along") {
  for (const char* name : {"circle", "eight", "spiral"}) {
    const auto shape = make_reference(name, {{"along", 1}, {"yaw", 0.2}});
    for (const double t : {0.1, 0.83, 2.6, 4.4}) {
      test::check_derivatives(*shape, t);
      const Reference r = shape->at(t);
      const double heading = std::atan2(r.velocity.y(), r.velocity.x());
      CHECK(std::abs(std::remainder(r.yaw - heading - 0.2, 2 * pi)) < 1e-12);
    }
  }
}

TEST_CASE("the spiral is that of the thesis, circle and eight those that are documented") {
  for (const double t : {0.0, 0.7, 12.3, 29.9}) {
    const Vector3d spiral(2 * std::cos(0.5 * t), 2 * std::sin(0.5 * t), 10 + t);
    CHECK((make_reference("spiral", {})->at(t).position - spiral).norm() < 1e-13);
    const Vector3d circle(2 * std::cos(1.5 * t), 2 * std::sin(1.5 * t), 10);
    CHECK((make_reference("circle", {})->at(t).position - circle).norm() < 1e-13);
    const Vector3d eight(2 * std::sin(1.2 * t), std::sin(2.4 * t), 10);
    CHECK((make_reference("eight", {})->at(t).position - eight).norm() < 1e-13);
  }
}

TEST_CASE("waypoints are passed on the path of least snap, which all equations at once give, too") {
  const Rows rows = five_waypoints();
  const auto path = make_reference("waypoints", {}, rows);
  CHECK(path->end() == 10.4);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    CHECK((path->at(rows(i, 0)).position - rows.row(i).tail<3>().transpose()).norm() < 1e-12);
  }
  for (const double t : {0.0, 0.31, 2.2, 3.9, 6.19, 8.7, 10.3999}) {
    const Reference r = path->at(t);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::VectorXd expected = dense_minimum_snap(rows, axis, t);
      const double got[] = {r.position[axis], r.velocity[axis], r.acceleration[axis], r.jerk[axis],
                            r.snap[axis]};
      for (int d = 0; d < 5; ++d) CHECK(std::abs(got[d] - expected[d]) < 1e-8);
    }
  }
  for (const double t : {10.4, 20.0}) {
    const Reference r = path->at(t);
    CHECK(r.velocity.isZero(0));
    CHECK(r.position == Vector3d(0, 0, 10));
  }
}

TEST_CASE("a series tells the motion it was taken from, its ends included") {
  Rows rows(301, 5);
  for (int i = 0; i < 301; ++i) {
    const double t = 0.02 * i;
    rows.row(i) << t, std::cos(1.3 * t), std::sin(1.3 * t), 1 + 0.2 * t, 0.3 * std::sin(t);
  }
  const auto series = make_reference("series", {}, rows);
  for (const double t : {1.001, 2.37, 3.99, 4.8}) {
    const Reference r = series->at(t);
    CHECK(std::abs(r.position.x() - std::cos(1.3 * t)) < 1e-9);
    CHECK(std::abs(r.acceleration.y() + 1.69 * std::sin(1.3 * t)) < 1e-5);
    CHECK(std::abs(r.snap.x() - std::pow(1.3, 4) * std::cos(1.3 * t)) < 1e-2);
    CHECK(std::abs(r.yaw_acceleration + 0.3 * std::sin(t)) < 1e-5);
  }
  CHECK((series->at(0).velocity - Vector3d(0, 1.3, 0.2)).norm() < 1e-2);
}

namespace {

/// A motion with no symmetry, written with a number of digits.
Rows write_rows(double rate, int digits, double begin = 0) {
  const int n = static_cast<int>(std::lround(8 * rate)) + 1;
  Rows rows(n, 5);
  const double unit = std::pow(10.0, -digits);
  for (int i = 0; i < n; ++i) {
    const double t = i / rate;
    rows.row(i) << t + begin, 2 * std::cos(1.5 * t), 1.4 * std::sin(1.1 * t),
        3 + 0.3 * t + 0.2 * std::sin(2 * t), std::remainder(2.5 + 0.8 * t, 2 * pi);
    rows.row(i).tail<4>() = (rows.row(i).tail<4>() / unit).array().round() * unit;
  }
  return rows;
}

}  // namespace

TEST_CASE("a series is flown as the motion, not as its digits") {
  struct Telling {
    double rate;
    int digits;
    double position, snap;  // bars [m, m/s^4]
  };
  for (const Telling& telling : {Telling{100, 6, 2e-6, 0.2}, Telling{1000, 9, 2e-9, 0.05},
                                 Telling{50, 4, 2e-4, 2}, Telling{100, 3, 2e-3, 8}}) {
    CAPTURE(telling.digits);
    const auto series = make_reference("series", {}, write_rows(telling.rate, telling.digits));
    for (double t = 0.5; t < 7.5; t += 0.0317) {
      const Reference r = series->at(t);
      const Vector3d p(2 * std::cos(1.5 * t), 1.4 * std::sin(1.1 * t),
                       3 + 0.3 * t + 0.2 * std::sin(2 * t));
      const Vector3d s(2 * std::pow(1.5, 4) * std::cos(1.5 * t),
                       1.4 * std::pow(1.1, 4) * std::sin(1.1 * t), 3.2 * std::sin(2 * t));
      CHECK((r.position - p).norm() < telling.position);
      CHECK((r.snap - s).norm() < telling.snap);
    }
  }
}

TEST_CASE("rows with noise are smoothed as far as they are said to lie off") {
  Rows rows = write_rows(100, 12);
  test::Draw draw{5};
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    rows(i, 1) += 1e-3 * std::clamp(draw.number(), -1.0, 1.0);
  const auto series = make_reference("series", {{"tolerance", 1.5e-3}}, rows);
  for (double t = 0.5; t < 7.5; t += 0.1) {
    CHECK(std::abs(series->at(t).position.x() - 2 * std::cos(1.5 * t)) < 1.5e-3);
    CHECK(std::abs(series->at(t).acceleration.x() + 4.5 * std::cos(1.5 * t)) < 0.2);
  }
}

TEST_CASE("the yaw of a series goes on where its numbers jump by a turn") {
  for (const int digits : {6, 14}) {
    const auto series = make_reference("series", {}, write_rows(100, digits));
    for (double t = 0.1; t < 8; t += 0.113) {
      CHECK(series->at(t).yaw == doctest::Approx(2.5 + 0.8 * t).epsilon(1e-6));
      CHECK(series->at(t).yaw_rate == doctest::Approx(0.8).epsilon(1e-2));
    }
  }
}

TEST_CASE("a series begins at once, whatever the time of its first row") {
  const auto early = make_reference("series", {}, write_rows(20, 12)),
             late = make_reference("series", {}, write_rows(20, 12, 17.5));
  CHECK(late->end() == doctest::Approx(8));
  for (const double t : {0.0, 2.2, 7.9}) {
    CHECK((early->at(t).position - late->at(t).position).norm() < 1e-9);
    CHECK((early->at(t).velocity - late->at(t).velocity).norm() < 1e-6);
  }
}

TEST_CASE("paths through rows have a yaw from parameters where their rows have none") {
  const Rows rows = five_waypoints();
  for (const char* name : {"waypoints", "series"}) {
    CAPTURE(name);
    const auto turning = make_reference(name, {{"yaw", 0.3}, {"yaw_rate", -0.4}}, rows);
    CHECK(turning->at(2).yaw == doctest::Approx(0.3 - 0.8));
    const auto along = make_reference(name, {{"along", 1}, {"yaw", 0.2}}, rows);
    for (const double t : {0.6, 3.1, 7.7}) {
      test::check_derivatives(*along, t);
      const Reference r = along->at(t);
      const double heading = std::atan2(r.velocity.y(), r.velocity.x());
      CHECK(std::abs(std::remainder(r.yaw - heading - 0.2, 2 * pi)) < 1e-12);
    }
    // Where it rests it looks as it leaves, and as it came.
    for (const double end : {0.0, 10.4}) {
      const double inside = end == 0 ? 1e-3 : end - 1e-3;
      CHECK(std::abs(std::remainder(along->at(end).yaw - along->at(inside).yaw, 2 * pi)) < 0.02);
    }
    CHECK(along->at(30).yaw == along->at(10.4).yaw);
    CHECK(test::contains(
        test::refusal([&] { make_reference(name, {{"along", 1}}, write_rows(10, 6)); }),
        "its rows and 'along' both set the yaw"));
  }
}

TEST_CASE("what never moves has no direction of motion to point along") {
  for (const char* name : {"hover", "step", "takeoff_land"}) {
    CHECK(test::contains(test::refusal([&] { make_reference(name, {{"along", 1}}); }),
                         "has no parameter 'along'"));
  }
}

TEST_CASE("a vehicle that takes off turns in the hover and nowhere else") {
  const auto shape = make_reference("takeoff_land", {{"yaw", 0.5}, {"turn", -2}, {"stay", 6}});
  for (const double t : {0.0, 2.5, 5.0}) CHECK(shape->at(t).yaw == 0.5);
  for (const double t : {11.0, 13.0, 16.0}) CHECK(shape->at(t).yaw == -1.5);
  CHECK(shape->at(8).yaw == doctest::Approx(-0.5));
  CHECK(shape->at(8).yaw_rate < -0.3);
}

TEST_CASE("take-off and landing begin and end at rest on the ground") {
  const auto shape = make_reference("takeoff_land", {{"height", 2}, {"stay", 3}});
  CHECK(shape->end() == 12);
  CHECK(shape->at(0).position.z() == 0.0125);
  CHECK(shape->at(6).position.z() == 2);
  CHECK(shape->at(30).position.z() == 0.0125);
  CHECK(shape->at(5).acceleration.norm() < 1e-12);
}

TEST_CASE("what is no reference is refused with what to write instead") {
  const auto refused = [](const char* name, const Values& values, const Rows& rows = {}) {
    return test::refusal([&] { make_reference(name, values, rows); });
  };
  CHECK(test::contains(refused("spirale", {}),
                       "reference 'spirale' does not exist. Did you mean 'spiral'?"));
  CHECK(test::contains(refused("spiral", {{"radios", 1}}), "Did you mean 'radius'?"));
  CHECK(test::contains(refused("spiral", {{"radius", -1}}), "'radius' is -1. Give"));
  CHECK(test::contains(refused("circle", {{"along", 2}}), "'along' is 2. Give true or false"));
  CHECK(test::contains(refused("waypoints", {}), "requires rows"));
  CHECK(test::contains(refused("hover", {}, five_waypoints()), "accepts no rows"));
  Rows rows = five_waypoints();
  rows(3, 0) = 4.2;
  CHECK(test::contains(refused("waypoints", {}, rows), "row 4 of the path is not later"));
}
