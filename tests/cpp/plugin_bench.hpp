#pragma once

#include "quadcore/plugin/random.hpp"
#include "vehicle.hpp"

/// \file
/// Plugins apart from every engine: a test calls their hooks with any motion it likes.

namespace quadcore::test {

/// Draws that repeat.
struct Draw {
  std::uint64_t seed;
  double count = 0;

  double number() { return random_normal(seed, count); }
  Vector3d vector() { return {number(), number(), number()}; }
  Vector3d direction() { return vector().normalized(); }
  Quaterniond rotation() {
    return Quaterniond(number(), number(), number(), number()).normalized();
  }
};

/// A motion in which no two members agree, so that none can be taken for another.
inline Kinematics any_motion(std::uint64_t seed, std::size_t rotors) {
  Draw draw{seed};
  Kinematics k(rotors, true);
  k.p_WF = 10 * draw.vector();
  k.q_WF = draw.rotation();
  k.R_WF = k.q_WF.toRotationMatrix();
  k.v_WF_F = 5 * draw.vector();
  k.w_WF_F = 2 * draw.vector();
  k.p_FCcm_F = 0.1 * draw.vector();
  k.v_WCcm_F = 5 * draw.vector();
  k.v_WA_F = 3 * draw.vector();
  for (std::size_t i = 0; i < rotors; ++i) {
    RotorKinematics rotor;
    rotor.axis_F = draw.direction();
    rotor.p_FRcm_F = 0.3 * draw.vector();
    rotor.v_WR_F = 5 * draw.vector();
    rotor.v_WRcm_F = 5 * draw.vector();
    rotor.rate = 300 * draw.number();
    k.rotors.set_matrix(MotionRow::R_FR_at_zero, i, draw.rotation().toRotationMatrix());
    const Matrix3d R_FR = draw.rotation().toRotationMatrix();
    k.rotors.set_matrix(MotionRow::R_FR, i, R_FR);
    rotor.normal_F = R_FR.col(2);
    k.rotors.set(i, rotor);
  }
  return k;
}

/// A vehicle with one plugin of the shipped ones, rotors a, b, c and so on.
inline Model vehicle_with(const std::string& plugin, const std::string& tags, std::size_t rotors) {
  std::string text = link("frame", 1, skew_body);
  for (std::size_t i = 0; i < rotors; ++i) {
    const std::string name(1, static_cast<char>('a' + i));
    text += link("propeller_" + name, 0.01, round_rotor) +
            joint(name, "continuous", "frame", "propeller_" + name);
  }
  return model(text + "<gazebo><plugin name=\"it\" filename=\"lib" + plugin + "_plugin.so\">" +
               tags + "</plugin></gazebo>\n");
}

inline std::string tag(const std::string& name, const std::string& value) {
  return "<" + name + ">" + value + "</" + name + ">";
}

struct PluginBench {
  Simulation simulation;  ///< makes the plugin; never stepped
  const LoadedPlugin& loaded = simulation.plugins().front();
  Topics topics = simulation.topics();
  VectorXd memory = VectorXd::Zero(loaded.state_size);
  std::vector<std::string> warnings;

  PluginBench(const std::string& plugin, const std::string& tags, std::size_t rotors,
              std::uint64_t seed = 0, const std::string& engine = "gazebo11")
      : simulation(vehicle_with(plugin, tags, rotors), World{}, options(seed, engine)) {}

  PluginState state() { return {memory.data(), memory.size()}; }
  Sample sample(const Kinematics& kinematics, double time, double dt, bool jumped = false) {
    return {time, dt, kinematics, simulation.world(), topics, warnings, loaded.seed, jumped};
  }
  void update(const Kinematics& kinematics, double time, double dt) {
    topics.write_as(0);
    loaded.plugin->update(sample(kinematics, time, dt), state());
    topics.write_as(the_caller);
  }
  void sense(const Kinematics& kinematics, double time, bool jumped = false) {
    topics.write_as(0);
    loaded.plugin->sense(sample(kinematics, time, 1e-3, jumped), state());
    topics.write_as(the_caller);
  }
  Loads forces(const Kinematics& kinematics) {
    Loads loads(kinematics.rotors.size());
    loaded.plugin->forces(kinematics, {memory.data(), memory.size()}, loads);
    return loads;
  }

 private:
  static SimulationOptions options(std::uint64_t seed, const std::string& engine) {
    SimulationOptions options;
    options.seed = seed;
    options.engine = engine;
    return options;
  }
};

}  // namespace quadcore::test
