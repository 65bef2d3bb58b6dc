#include <algorithm>
#include <cmath>

#include "plugin_bench.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

constexpr double kp = 5e-4, ki = 2e-3, kd = 3e-7, i_max = 1.5e-3, i_min = -4e-4;
constexpr double slow = 2, max_velocity = 700, timeout = 0.05, dt = 0.004;
const std::string gains = tag("kp", "5e-4") + tag("ki", "2e-3") + tag("kd", "3e-7") +
                          tag("iMax", "1.5e-3") + tag("iMin", "-4e-4") + tag("sim_slow", "2");

struct Motors : PluginBench {
  std::size_t topic = static_cast<std::size_t>(topics.find("vel_cmd"));

  Motors(const std::string& tags, std::size_t rotors) : PluginBench("motorpid", tags, rotors) {}
  void command(double time, const std::vector<double>& speeds) {
    std::copy(speeds.begin(), speeds.end(), topics.publish(topic, time));
  }
};

/// The controller of one rotor as Gazebo's JointController has it, with clamped integral.
struct Reference {
  double integral = 0, last_error = 0;

  double torque(double rate, double target) {
    const double error = rate - target;
    integral = std::min(std::max(integral + ki * dt * error, i_min), i_max);
    const double derivative = kd * (error - last_error) / dt;
    last_error = error;
    return -kp * error - integral - derivative;
  }
};

}  // namespace

TEST_CASE("each motor is a PID of its own, with limits, timeout and slow-down") {
  Motors motors(
      gains + tag("maxVelocity", "700") + tag("commandTimeout", "0.05") + tag("rotorJoints", "j a"),
      11);  // laws take eight at a time
  Draw draw{7};
  Reference c, a;
  int saturated = 0, stale_steps = 0;
  double stamp = 0;
  std::vector<double> command;
  for (int step = 0; step < 400; ++step) {
    const double time = step * dt;
    if (step % 29 == 0) {
      command = {500 * draw.number(), 500 * draw.number()};
      stamp = time;
      motors.command(time, command);
      saturated += std::abs(command[0]) > max_velocity;
    }
    Kinematics motion(11);
    for (std::size_t i = 0; i < 11; ++i) {
      motion.rotors.number(MotionRow::rate, i) = 200 * draw.number();
    }
    motors.update(motion, time, dt);

    const bool stale = time - stamp > timeout;
    stale_steps += stale;
    const auto target = [&](double wanted) {
      if (stale) wanted = 0;
      return std::min(std::max(wanted, -max_velocity), max_velocity) / slow;
    };
    const Loads loads = motors.forces(motion);
    CHECK(loads.joint_torque(9) ==
          doctest::Approx(c.torque(motion.rotors[9].rate, target(command[0]))).epsilon(1e-9));
    CHECK(loads.joint_torque(0) ==
          doctest::Approx(a.torque(motion.rotors[0].rate, target(command[1]))).epsilon(1e-9));
    CHECK(loads.joint_torque(1) == 0);
    CHECK(loads.joint_torque(3) == 0);
    CHECK(loads.frame().torque_F.isZero(0));
    // Between the samples the proportional law goes on, the others are held.
    const double before = loads.joint_torque(9);
    motion.rotors.number(MotionRow::rate, 9) += 3;
    CHECK(motors.forces(motion).joint_torque(9) - before == doctest::Approx(-kp * 3));
  }
  CHECK(saturated > 0);
  CHECK(stale_steps > 100);
}

TEST_CASE("a command that is exactly as old as the timeout still counts") {
  Motors motors(tag("kp", "5e-4") + tag("commandTimeout", "0.5"), 1);
  motors.command(1, {300});
  const Kinematics still(1);
  motors.update(still, 1.5, dt);
  CHECK(motors.forces(still).joint_torque(0) == doctest::Approx(kp * 300));
  motors.update(still, 1.75, dt);
  CHECK(motors.forces(still).joint_torque(0) == 0);
}

TEST_CASE("motors without limit, timeout, integral or derivative just follow") {
  Motors motors(tag("kp", "5e-4"), 2);
  motors.command(0, {1e5, -1e5});
  Kinematics motion(2);
  for (const double time : {0.0, 1e6}) {
    motors.update(motion, time, dt);
    CHECK(motors.forces(motion).joint_torque(0) == doctest::Approx(kp * 1e5));
    CHECK(motors.forces(motion).joint_torque(1) == doctest::Approx(-kp * 1e5));
    for (std::size_t i = 0; i < 2; ++i) motion.rotors.number(MotionRow::rate, i) = 0;
  }
}

TEST_CASE("motors are free until the first command, even one of zeros") {
  Motors motors(gains, 2);
  Kinematics motion(2);
  for (std::size_t i = 0; i < 2; ++i) motion.rotors.number(MotionRow::rate, i) = 100;
  motors.update(motion, 0, dt);
  CHECK(motors.forces(motion).joint_torque(0) == 0);
  CHECK(motors.memory.isZero(0));
  motors.command(0, {0, 0});
  motors.update(motion, 0, dt);
  CHECK(motors.forces(motion).joint_torque(0) < -kp * 100);
}

TEST_CASE("limits of the integral are checked against each other and against its gain") {
  const auto limits = [](const std::string& high, const std::string& low) {
    return tag("kp", "5e-4") + tag("ki", "1") + tag("iMax", high) + tag("iMin", low);
  };
  const auto warnings = [&](const std::string& tags) {
    std::vector<std::string> of_limits;
    const Motors motors(tags, 1);
    for (const std::string& warning : motors.simulation.warnings()) {
      if (contains(warning, "<iMax>")) of_limits.push_back(warning);
    }
    return of_limits;
  };
  for (const auto& [high, low] : {std::pair{"0.1", "0"}, {"0", "-0.1"}, {"0.1", "-0.1"}}) {
    CHECK(warnings(limits(high, low)).empty());
  }
  REQUIRE(warnings(limits("0", "0")).size() == 1);
  CHECK(
      contains(warnings(limits("0", "0"))[0], "<ki> has no effect while <iMax> and <iMin> are 0"));
  CHECK(warnings(tag("kp", "1")).empty());
}

TEST_CASE("a vehicle's motors take as many numbers as they have rotors") {
  Motors three(gains + tag("rotorJoints", "a b d"), 4);
  CHECK(three.topics[three.topic].kind.fields == std::vector<std::string>{"w1", "w2", "w3"});
  CHECK(three.simulation.command_width() == 3);
  const Motors eight(gains, 8), nine(gains, 9);  // blocks of the widest lanes
  CHECK(three.memory.size() == eight.memory.size());
  CHECK(nine.memory.size() == 2 * eight.memory.size());
}
