#include <cmath>

#include "plugin_bench.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

constexpr double k = 1.2e-5, b = 3e-7, slow = 2.5;
constexpr double K_I = 0.011, K_T = 0.0023, K_P = 0.0057, K_par = 0.0031;
constexpr double A1c = 0.12, A1s = 0.031, B1 = 0.0042, B2 = 0.0027, r = 0.09;
constexpr std::size_t rotor_count = 11;                // laws take eight at a time
const std::vector<std::size_t> named = {3, 0, 10, 2};  // d a k c

const std::string thrust_only = tag("rotorThrustCoeff", "1.2e-5") + tag("rotorTorqueCoeff", "3e-7");
const std::string everything =
    thrust_only + tag("sim_slow", "2.5") + tag("inducedDragCoeff", "0.011") +
    tag("translationalDragCoeff", "0.0023") + tag("profileDragCoeff", "0.0057") +
    tag("parasiticDragCoeff", "0.0031") + tag("flappingA1c", "0.12") + tag("flappingA1s", "0.031") +
    tag("flappingB1", "0.0042") + tag("flappingB2", "0.0027") + tag("rotorRadius", "0.09") +
    tag("rotorJoints", "d a k c");

enum Term { thrust, reaction, induced, translational, profile, parasitic, flapping, term_count };

/// What each term exerts, term by term from the thesis' equations, in components.
struct Expected {
  Vector3d force_on_rotor[term_count][rotor_count];
  Vector3d torque_F = Vector3d::Zero();          ///< reaction, on the frame
  Vector3d force_on_frame_F = Vector3d::Zero();  ///< parasitic, at the vehicle's centre of mass

  Expected(const Kinematics& m, bool appendix, double reaction_sign) {
    for (auto& forces : force_on_rotor) std::fill(forces, forces + rotor_count, Vector3d::Zero());
    for (const std::size_t i : named) {
      const RotorKinematics& rotor = m.rotors[i];
      const double W = rotor.rate * slow, s = W < 0 ? -1 : 1;
      const Vector3d a = appendix ? m.R_FR(i) * Vector3d::UnitZ() : rotor.axis_F;
      const Vector3d v = appendix ? rotor.v_WR_F : Vector3d(rotor.v_WRcm_F - m.v_WA_F);
      // Axes of the disc.
      const Vector3d e1 = a.cross(Vector3d(0.3, -0.5, 0.7)).normalized(), e2 = a.cross(e1);
      const double v1 = v.dot(e1), v2 = v.dot(e2);
      const double n1 = m.w_WF_F.dot(e1), n2 = m.w_WF_F.dot(e2);

      force_on_rotor[thrust][i] = k * W * W * a;
      torque_F +=
          reaction_sign * b * W * std::abs(W) * (appendix ? Vector3d(Vector3d::UnitZ()) : a);
      force_on_rotor[induced][i] = -K_I * (v1 * e1 + v2 * e2);
      force_on_rotor[translational][i] = -K_T * (v1 * e1 + v2 * e2);
      force_on_rotor[profile][i] = -K_P * (v1 * e1 + v2 * e2);
      force_on_rotor[flapping][i] = k * std::abs(W) *
                                    (e1 * ((-A1c * v1 + s * A1s * v2) / r - s * B2 * n1 + B1 * n2) +
                                     e2 * ((-s * A1s * v1 - A1c * v2) / r - B1 * n1 - s * B2 * n2));
      if (appendix) {
        const Vector3d w = m.R_WF * m.v_WF_F;
        const Vector3d in_propeller(w.x() * std::abs(w.x()), w.y() * std::abs(w.y()),
                                    w.z() * std::abs(w.z()));
        force_on_rotor[parasitic][i] = m.R_FR(i) * (-K_par * in_propeller);
      }
    }
    if (!appendix) {
      const Vector3d v = m.v_WCcm_F - m.v_WA_F;
      force_on_frame_F = -K_par * std::sqrt(v.dot(v)) * v;
    }
  }
};

}  // namespace

TEST_CASE("each force law is the thesis', in whatever motion, with and without a log") {
  for (const bool appendix : {true, false}) {
    for (const bool opposing : {true, false}) {
      CAPTURE(appendix);
      CAPTURE(opposing);
      PluginBench bench("aerodynamic",
                        everything + tag("dragModel", appendix ? "appendix" : "chapter2") +
                            tag("reactionTorque", opposing ? "opposing" : "thesis"),
                        rotor_count);
      for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const Kinematics motion = any_motion(seed, rotor_count);
        const Expected expected(motion, appendix, opposing ? -1 : 1);

        Wrench terms[term_count];
        Loads logged(rotor_count);
        logged.record_terms(terms, term_count, &motion);
        bench.loaded.plugin->forces(motion, {bench.memory.data(), bench.memory.size()}, logged);
        for (int term = 0; term < term_count; ++term) {
          CAPTURE(term);
          Wrench sum;
          for (std::size_t i = 0; i < rotor_count; ++i) {
            const Vector3d& f_F = expected.force_on_rotor[term][i];
            sum.force_F += f_F;
            sum.torque_F += (motion.rotors[i].p_FRcm_F - motion.p_FCcm_F).cross(f_F);
          }
          if (term == reaction) sum.torque_F += expected.torque_F;
          if (term == parasitic) sum.force_F += expected.force_on_frame_F;
          CHECK((terms[term].force_F - sum.force_F).norm() < 1e-12);
          CHECK((terms[term].torque_F - sum.torque_F).norm() < 1e-12);
        }

        const Loads unlogged = bench.forces(motion);
        for (const Loads* loads : {static_cast<const Loads*>(&logged), &unlogged}) {
          for (std::size_t i = 0; i < rotor_count; ++i) {
            Vector3d sum = Vector3d::Zero();
            for (const auto& forces : expected.force_on_rotor) sum += forces[i];
            CHECK((loads->rotor_force_F(i) - sum).norm() < 1e-12);
            CHECK(loads->joint_torque(i) == 0);
          }
          const Vector3d about_F =
              expected.torque_F + motion.p_FCcm_F.cross(expected.force_on_frame_F);
          CHECK((loads->frame().force_F - expected.force_on_frame_F).norm() < 1e-12);
          CHECK((loads->frame().torque_F - about_F).norm() < 1e-12);
        }
      }
    }
  }
}

TEST_CASE("drag that drives is reported where a propeller's axis points down, once") {
  int warned = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    PluginBench bench("aerodynamic", everything, rotor_count);
    Kinematics motion = any_motion(seed, rotor_count);
    motion.v_WA_F.setZero();
    for (std::size_t i = 0; i < rotor_count; ++i) motion.rotors.number(MotionRow::rate, i) = 100;
    bool down = false;
    for (const std::size_t i : named) {
      down = down || (motion.R_WF * (motion.R_FR(i) * Vector3d::UnitZ())).z() < 0;
    }
    for (int i = 0; i < 3; ++i) bench.update(motion, 0.1 * i, 1e-3);
    CHECK(bench.warnings.size() == (down ? 1 : 0));
    warned += down;
  }
  CHECK(warned > 5);
  CHECK(warned < 100);
}

TEST_CASE("an axis against the propeller's z is warned of, one across it is not") {
  std::string rotors;
  for (const std::string axis : {"0 0 1", "1 0 0", "0 0.6 -0.8", "0 0 -1"}) {
    std::string turning = joint("turn" + axis, "continuous", "frame", "rotor" + axis);
    turning.replace(turning.find("0 0 1\"/>"), 5, axis);
    rotors += link("rotor" + axis, 0.01, round_rotor) + turning;
  }
  const Simulation simulation(
      model(link("frame", 1, skew_body) + rotors +
            "<gazebo><plugin name=\"it\" filename=\"libaerodynamic_plugin.so\">" + thrust_only +
            "</plugin></gazebo>\n"),
      World{}, {});
  std::string messages;
  for (const std::string& warning : simulation.warnings()) messages += warning;
  CHECK_FALSE(contains(messages, "'turn0 0 1'"));
  CHECK_FALSE(contains(messages, "'turn1 0 0'"));
  CHECK(contains(messages, "'turn0 0.6 -0.8'"));
  CHECK(contains(messages, "'turn0 0 -1'"));
}

TEST_CASE("loads are finite only if those on every rotor are") {
  for (std::size_t i = 0; i < rotor_count; ++i) {
    Loads loads(rotor_count);
    loads.add_rotor_force(0, i, {0, 1, 0});
    CHECK(loads.all_finite());
    loads.add_joint_torque(i, NAN);
    CHECK_FALSE(loads.all_finite());
  }
}

TEST_CASE("a joint takes one rate at a time, which must be finite") {
  Loads loads(rotor_count);
  loads.prescribe_joint_rate(1, {3, 0});
  CHECK(loads.any_rate());
  CHECK(loads.all_finite());
  CHECK_THROWS_WITH_AS(loads.prescribe_joint_rate(1, {3, 0}),
                       "the rate of joint 1, counted from 0, is prescribed twice. Let only one "
                       "plugin drive each joint.",
                       Error);
  CHECK_THROWS_AS(loads.prescribe_joint_rate(rotor_count, {3, 0}), Error);
  loads.clear();
  CHECK_FALSE(loads.any_rate());
  CHECK_FALSE(loads.joint_rate(1));
  loads.prescribe_joint_rate(1, {3, NAN});
  CHECK_FALSE(loads.all_finite());
}

TEST_CASE("each flapping coefficient alone flaps") {
  const Kinematics motion = any_motion(1, 1);
  for (const char* name : {"flappingA1c", "flappingA1s", "flappingB1", "flappingB2"}) {
    CAPTURE(name);
    PluginBench with("aerodynamic", thrust_only + tag(name, "0.01"), 1);
    PluginBench without("aerodynamic", thrust_only, 1);
    const Vector3d difference =
        with.forces(motion).rotor_force_F(0) - without.forces(motion).rotor_force_F(0);
    CHECK(difference.norm() > 1e-6);
  }
}

TEST_CASE("a rotor on a hinge that turns more than half a turn per step ends the flight") {
  PluginBench bench("aerodynamic", everything, rotor_count);
  constexpr double dt = 0.004;
  Kinematics motion(rotor_count);
  for (const double sign : {1.0, -1.0}) {
    for (std::size_t i = 0; i < rotor_count; ++i)
      motion.rotors.number(MotionRow::rate, i) = sign * 3.1415 / dt;
    bench.update(motion, 1.5, dt);
    motion.rotors.number(MotionRow::rate, 1) = sign * 3.1417 / dt;  // not one of its rotors
    bench.update(motion, 1.5, dt);
    motion.rotors.number(MotionRow::rate, 2) = sign * 3.1417 / dt;
    CHECK_THROWS_WITH_AS(
        bench.update(motion, 1.5, dt),
        "rotor 'c' turns more than half a turn per step. Use a smaller step or a slower command.",
        FlightError);
  }
}

TEST_CASE(
    "an engine without hinges warns once of a rotor that turns more than half a turn per step") {
  PluginBench bench("aerodynamic", everything, rotor_count, 0, "eigen");
  constexpr double dt = 0.004;
  Kinematics motion(rotor_count);
  bench.update(motion, 1.5, dt);
  CHECK(bench.warnings.empty());
  motion.rotors.number(MotionRow::rate, 2) = 3.1417 / dt;
  for (int n = 0; n < 3; ++n) bench.update(motion, 1.5 + n * dt, dt);
  REQUIRE(bench.warnings.size() == 1);
  CHECK(contains(bench.warnings.front(), "rotor 'c' turns more than half a turn per step, so its"));
}
