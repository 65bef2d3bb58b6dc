#include <cmath>

#include "center_of_mass.hpp"
#include "naming.hpp"
#include "quadcore/plugin.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/random.hpp"
#include "standard_random.hpp"

namespace quadcore::rotors {
namespace {

/// The errors of three like sensors. Their memory: the bias at turn-on and the one that drifts.
struct Errors {
  enum Memory { kTurnOn, kDrift = 3, kMemorySize = kDrift + 3 };

  double density, turn_on;
  double white;         ///< standard deviation of a sample's noise
  double kept, spread;  ///< of the drift in a step: what stays, and what comes to it

  Errors(const PluginSetup& setup, const std::string& name, const std::string& walk_name)
      : density(setup.parameters.number(name + "NoiseDensity")),
        turn_on(setup.parameters.number(name + "TurnOnBiasSigma")),
        white(density / std::sqrt(setup.dt)) {
    // The exact discretisation (Maybeck, 1979, eq. (4-114)).
    const double walk = setup.parameters.number(walk_name);
    const double time = setup.parameters.number(name + "BiasCorrelationTime");
    kept = elementary::exp(-setup.dt / time);
    spread = std::sqrt(walk * walk * time / 2 * (1 - elementary::exp(-2 * setup.dt / time)));
  }

  /// What one axis has at the end of a step.
  template <class Draw>
  double of_axis(int axis, Eigen::Ref<VectorXd> memory, const Draw& draw) const {
    double& drift = memory[kDrift + axis];
    drift = kept * drift + spread * draw();
    return drift + white * draw() + memory[kTurnOn + axis];
  }
};

/// What it remembers: whether it is turned on, the velocity a step before (world axes), how far
/// its numbers of chance are drawn, the errors.
enum Memory {
  kOn,
  kVelocity,
  kDraws = kVelocity + 3,
  kRandom,
  kGyroscope = kRandom + StandardRandom::kMemorySize,
  kAccelerometer = kGyroscope + Errors::kMemorySize,
  kMemorySize = kAccelerometer + Errors::kMemorySize
};

/// Rates and specific force at the start of each step, the latter from the change of the velocity
/// of the link's centre of mass since the step before, both with RotorS' errors.
class Imu final : public Plugin {
 public:
  explicit Imu(const PluginSetup& setup)
      : R_SF_(place_of(setup, "linkName").rotation().toRotationMatrix().transpose()),
        p_FScm_F_(place_of(setup, "linkName").xyz +
                  R_SF_.transpose() *
                      center_of_mass(setup.model, setup.parameters.text("linkName"))),
        gyroscope_(setup, "gyroscope", "gyroscopeBiasRandomWalk"),
        accelerometer_(setup, "accelerometer", "accelerometerRandomWalk"),
        as_rotors_(setup.parameters.choice("noise") == "rotors"),
        topic_(setup.topics.publishes(topic_of(setup, "imuTopic"),
                                      messages::kind_of<messages::Imu>())) {}

  std::size_t state_size() const override { return kMemorySize; }

  void sense(const Sample& sample, PluginState state) const override {
    if (sample.jumped) state.segment<3>(kVelocity) = sample.kinematics.v_WS_W(p_FScm_F_);
  }

  void update(const Sample& sample, PluginState state) const override {
    const Kinematics& k = sample.kinematics;
    const auto draw = [&] {
      if (!as_rotors_) return random_normal(sample.seed, state[kDraws]);
      return StandardRandom(state.segment(kRandom, StandardRandom::kMemorySize)).normal();
    };
    auto gyroscope = state.segment(kGyroscope, Errors::kMemorySize);
    auto accelerometer = state.segment(kAccelerometer, Errors::kMemorySize);
    if (state[kOn] == 0) {
      state[kOn] = 1;
      for (int i = 0; i < 3; ++i) {
        gyroscope[Errors::kTurnOn + i] = gyroscope_.turn_on * draw();
        accelerometer[Errors::kTurnOn + i] = accelerometer_.turn_on * draw();
      }
    }
    const Vector3d v_WScm_W = k.v_WS_W(p_FScm_F_);
    const Vector3d a_W = (v_WScm_W - state.segment<3>(kVelocity)) / sample.dt;
    state.segment<3>(kVelocity) = v_WScm_W;
    messages::Imu message;
    message.angular_velocity = R_SF_ * k.w_WF_F;
    message.specific_force = R_SF_ * (k.R_WF.transpose() * (a_W - sample.world.gravity_W));
    for (int i = 0; i < 3; ++i) {
      message.angular_velocity[i] += gyroscope_.of_axis(i, gyroscope, draw);
    }
    for (int i = 0; i < 3; ++i) {
      message.specific_force[i] += accelerometer_.of_axis(i, accelerometer, draw);
    }
    // As RotorS tells them, of the densities and not of the samples.
    message.angular_velocity_variance = gyroscope_.density * gyroscope_.density;
    message.specific_force_variance = accelerometer_.density * accelerometer_.density;
    sample.topics.publish(topic_, sample.time + sample.dt, message);
  }

 private:
  Matrix3d R_SF_;
  Vector3d p_FScm_F_;  ///< of the link's centre of mass [m]
  Errors gyroscope_, accelerometer_;
  bool as_rotors_;
  std::size_t topic_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  const auto add = [](const char* name, const char* unit, const char* fallback,
                      const char* meaning) {
    return T::number(name, unit, fallback, meaning).at_least(0).at_most(1e6).from("RotorS");
  };
  return {
      "RotorS' inertial measurement unit: of the state a step before its stamp, each step",
      {
          T::link("linkName", "the link that it sits on; its axes are the unit's").must(),
          T::text("imuTopic", "imu", "where the messages are published").from("RotorS"),
          add("gyroscopeNoiseDensity", "rad/s/sqrt(Hz)", "0.0003393695767766752",
              "density of the white noise of the rates"),
          add("gyroscopeBiasRandomWalk", "rad/s^2/sqrt(Hz)", "3.8785094488762879e-05",
              "random walk of their bias"),
          add("gyroscopeBiasCorrelationTime", "s", "1000", "correlation time of that bias")
              .above(0)
              .at_most(1e12),
          add("gyroscopeTurnOnBiasSigma", "rad/s", "0.008726646259971648",
              "standard deviation of the bias at turn-on"),
          add("accelerometerNoiseDensity", "m/s^2/sqrt(Hz)", "0.004",
              "density of the white noise of the specific force"),
          add("accelerometerRandomWalk", "m/s^3/sqrt(Hz)", "0.006", "random walk of its bias"),
          add("accelerometerBiasCorrelationTime", "s", "300", "correlation time of that bias")
              .above(0)
              .at_most(1e12),
          add("accelerometerTurnOnBiasSigma", "m/s^2", "0.196",
              "standard deviation of the bias at turn-on"),
          T::choice("noise", {"rotors", "seeded"},
                    "quadcore's own: rotors, the same numbers of chance in each flight and each "
                    "unit, as RotorS has them; or those of the flight's seed"),
          idle("gyroscopeRandomWalk",
               "RotorS does not read it, either, though its vehicles set it; "
               "gyroscopeBiasRandomWalk counts"),
          namespace_tag(),
      },
      {},
      create<Imu>,
  };
}

}  // namespace
}  // namespace quadcore::rotors

QUADCORE_REGISTER_PLUGIN(quadcore::rotors::describe)
