#include <doctest/doctest.h>

#include <cmath>

#include "quadcore/plugin/random.hpp"
#include "quadcore/plugin/spatial.hpp"
#include "shortest_rotation.hpp"

using namespace quadcore;

namespace {

Vector3d random_vector(double& count) {
  return {random_normal(1, count), random_normal(1, count), random_normal(1, count)};
}

}  // namespace

TEST_CASE("roll, pitch and yaw turn about fixed x, y, z in this order") {
  const auto turned = [](double r, double p, double y, const Vector3d& v) -> Vector3d {
    return quaternion_from_rpy({r, p, y}) * v;
  };
  CHECK(turned(M_PI / 2, 0, 0, Vector3d::UnitY()).isApprox(Vector3d::UnitZ()));
  CHECK(turned(0, M_PI / 2, 0, Vector3d::UnitZ()).isApprox(Vector3d::UnitX()));
  CHECK(turned(0, 0, M_PI / 2, Vector3d::UnitX()).isApprox(Vector3d::UnitY()));
  // y -> z by the roll, z -> x by the pitch, x -> y by the yaw.
  CHECK(turned(M_PI / 2, M_PI / 2, M_PI / 2, Vector3d::UnitY()).isApprox(Vector3d::UnitY()));
  CHECK(turned(M_PI / 2, M_PI / 2, 0, Vector3d::UnitY()).isApprox(Vector3d::UnitX()));
}

TEST_CASE("roll, pitch and yaw come back from the orientation they make") {
  for (const double roll : {-3.0, -1.0, 0.0, 2.0}) {
    for (const double pitch : {-1.5, -0.5, 0.0, 1.0}) {
      for (const double yaw : {-3.1, 0.0, 0.7, 3.1}) {
        const Vector3d rpy(roll, pitch, yaw);
        CHECK((rpy_from_quaternion(quaternion_from_rpy(rpy)) - rpy).norm() < 1e-12);
      }
    }
  }
}

TEST_CASE("within about 1e-6 rad of a pitch of 90 degrees all of the turn is yaw") {
  for (const double sign : {1.0, -1.0}) {
    const Vector3d near(0.3, sign * (M_PI_2 - 1.7e-6), 0.1);
    CHECK((rpy_from_quaternion(quaternion_from_rpy(near)) - near).norm() < 1e-6);
    const Vector3d nearer(0.3, sign * (M_PI_2 - 1.2e-6), 0.1);
    CHECK((rpy_from_quaternion(quaternion_from_rpy(nearer)) -
           Vector3d(0, nearer.y(), 0.1 - sign * 0.3))
              .norm() < 1e-5);
  }
}

TEST_CASE("at a pitch of 90 degrees the orientation comes back, if not the angles") {
  for (const double pitch : {-M_PI / 2, M_PI / 2}) {
    const Quaterniond q = quaternion_from_rpy({0.4, pitch, -1.1});
    CHECK(quaternion_from_rpy(rpy_from_quaternion(q)).angularDistance(q) < 1e-7);
  }
}

TEST_CASE("composed poses move points like the one after the other") {
  double count = 0;
  for (int i = 0; i < 50; ++i) {
    const Pose a{random_vector(count), random_vector(count)};
    const Pose b{random_vector(count), random_vector(count)};
    const Vector3d point = random_vector(count);
    const auto move = [](const Pose& pose, const Vector3d& p) -> Vector3d {
      return pose.xyz + pose.rotation() * p;
    };
    CHECK((move(a * b, point) - move(a, move(b, point))).norm() < 1e-12);
  }
}

TEST_CASE("the shortest rotation takes one direction to the other about their normal") {
  double count = 0;
  for (int i = 0; i < 20; ++i) {
    const Vector3d from = random_vector(count), to = random_vector(count);
    const Quaterniond q = shortest_rotation(from, to);
    CHECK((q * from.normalized()).isApprox(to.normalized(), 1e-12));
    CHECK(std::abs(q.vec().dot(from)) < 1e-12);
    CHECK(q.w() > 0);
  }
}

TEST_CASE("the shortest rotation between opposite directions is half a turn about a normal") {
  for (const Vector3d& from : {Vector3d(0, 0, 2), Vector3d(0, -1, 0), Vector3d(3, 0, 0),
                               Vector3d(1, 2, 3), Vector3d(-0.1, 4, 0.2)}) {
    const Quaterniond q = shortest_rotation(from, -from);
    CHECK((q * from).isApprox(-from, 1e-6));
    CHECK(std::abs(q.vec().dot(from)) < 1e-12);
    CHECK(q.norm() == doctest::Approx(1).epsilon(1e-12));
  }
  const Quaterniond q = shortest_rotation(Vector3d::UnitX(), Vector3d(-1, 1e-7, 0));
  CHECK((q * Vector3d::UnitX()).isApprox(Vector3d(-1, 1e-7, 0), 1e-6));
}
