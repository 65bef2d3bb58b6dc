#include <cmath>

#include "plugin_bench.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

struct Odometry : PluginBench {
  std::size_t topic = static_cast<std::size_t>(topics.find("odom"));

  explicit Odometry(const std::string& tags, std::uint64_t seed = 0)
      : PluginBench("odometry", tags, 1, seed) {}
  const Topic& message() const { return topics[topic]; }
  VectorXd values() const {
    return Eigen::Map<const VectorXd>(message().values.data(),
                                      static_cast<Eigen::Index>(message().values.size()));
  }
};

const std::string noise = tag("positionNoise", "0.1") + tag("orientationNoise", "0.02") +
                          tag("linearVelocityNoise", "0.3") + tag("angularVelocityNoise", "0.4");

}  // namespace

TEST_CASE("odometry without noise is the truth, its linear velocity in the axes asked for") {
  const Kinematics k = any_motion(3, 1);
  for (const bool body : {false, true}) {
    Odometry odometry(tag("twistFrame", body ? "body" : "world"));
    odometry.sense(k, 0.25);
    CHECK(odometry.message().count == 2);  // one when the vehicle was spawned
    CHECK(odometry.message().stamp == 0.25);
    VectorXd wanted(17);
    wanted << k.p_WF, k.q_WF.coeffs(), body ? k.v_WF_F : Vector3d(k.q_WF * k.v_WF_F), k.w_WF_F, 0,
        0, 0, 0;
    CHECK((odometry.values() - wanted).norm() < 1e-14);
  }
}

TEST_CASE("noise is drawn in the order of the message, from the stream of seed and name") {
  const Kinematics k = any_motion(3, 1);
  for (const bool own_seed : {false, true}) {
    Odometry odometry(noise + (own_seed ? tag("seed", "12") : ""), 5);
    Draw draw{stream_seed(own_seed ? 12 : 5, "it")};
    for (int i = 1; i < 10; ++i) {
      odometry.sense(k, i);
      const Vector3d p = k.p_WF + 0.1 * draw.vector();
      const Vector3d turn = 0.02 * draw.vector();
      const Vector3d v = k.R_WF * k.v_WF_F + 0.3 * draw.vector();
      const Vector3d w = k.w_WF_F + 0.4 * draw.vector();
      const Quaterniond q = k.q_WF * Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
      VectorXd wanted(17);
      wanted << p, q.coeffs(), v, w, 0.01, 0.0004, 0.09, 0.16;
      CHECK((odometry.values() - wanted).norm() < 1e-13);
    }
  }
}

TEST_CASE("noise on one quantity leaves the others alone") {
  const Kinematics k = any_motion(3, 1);
  Odometry still("");
  still.sense(k, 1);
  const char* names[] = {"position", "orientation", "linearVelocity", "angularVelocity"};
  const int begin[] = {0, 3, 7, 10, 13};
  for (int i = 0; i < 4; ++i) {
    CAPTURE(names[i]);
    Odometry odometry(tag(std::string(names[i]) + "Noise", "0.1"));
    odometry.sense(k, 1);
    VectorXd difference = odometry.values() - still.values();
    CHECK(difference.segment(begin[i], begin[i + 1] - begin[i]).norm() > 1e-3);
    difference.segment(begin[i], begin[i + 1] - begin[i]).setZero();
    CHECK(difference[13 + i] == doctest::Approx(0.01));
    difference[13 + i] = 0;
    CHECK(difference.isZero(0));
  }
}

TEST_CASE("a message is sent at each multiple of the period, and at once after a jump") {
  const Kinematics k = any_motion(3, 1);
  Odometry odometry(tag("rate", "40"));
  odometry.sense(k, 0);
  std::vector<int> sent;
  double count = odometry.message().count;
  for (int step = 1; step <= 100; ++step) {  // of 1 ms
    odometry.sense(k, step * 1e-3);
    if (odometry.message().count == count) continue;
    CHECK(odometry.message().count == count + 1);
    CHECK(odometry.message().stamp == step * 1e-3);
    count = odometry.message().count;
    sent.push_back(step);
  }
  CHECK(sent == std::vector<int>{25, 50, 75, 100});
  odometry.sense(k, 0.101, true);
  CHECK(odometry.message().count == count + 1);
  odometry.sense(k, 0.101);
  CHECK(odometry.message().count == count + 1);
}

TEST_CASE("a seed is a whole number") {
  const std::string message = refusal([] { Odometry(tag("seed", "1.5")); });
  CHECK(contains(message, "<seed> is not a whole number. Write a whole number."));
}
