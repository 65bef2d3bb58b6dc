#include <cmath>

#include "center_of_mass.hpp"
#include "naming.hpp"
#include "quadcore/plugin.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/random.hpp"
#include "standard_random.hpp"

namespace quadcore::rotors {
namespace {

/// Errors of three sensors of one kind. Their memory consists of the turn-on bias and the drifting
/// bias.
struct Errors {
  enum Memory { kTurnOn, kDrift = 3, kMemorySize = kDrift + 3 };

  double density, turn_on;
  double white;         ///< standard deviation of a sample's noise
  double kept, spread;  ///< of the drift in a step: decay factor and added standard deviation

  Errors(const PluginSetup& setup, const std::string& name, const std::string& walk_name)
      : density(setup.parameters.number(name + "NoiseDensity")),
        turn_on(setup.parameters.number(name + "TurnOnBiasSigma")),
        white(density / std::sqrt(setup.dt)) {
    // Exact discretisation (Maybeck, 1979, eq. (4-114)).
    const double walk = setup.parameters.number(walk_name);
    const double time = setup.parameters.number(name + "BiasCorrelationTime");
    kept = elementary::exp(-setup.dt / time);
    spread = std::sqrt(walk * walk * time / 2 * (1 - elementary::exp(-2 * setup.dt / time)));
  }

  /// Return the error of one axis at the end of a step.
  template <class Draw>
  double of_axis(int axis, Eigen::Ref<VectorXd> memory, const Draw& draw) const {
    double& drift = memory[kDrift + axis];
    drift = kept * drift + spread * draw();
    return drift + white * draw() + memory[kTurnOn + axis];
  }
};

/// State: whether it is turned on, the velocity one step before (world axes), the number of random
/// numbers drawn, and the errors.
enum Memory {
  kOn,
  kVelocity,
  kDraws = kVelocity + 3,
  kRandom,
  kGyroscope = kRandom + StandardRandom::kMemorySize,
  kAccelerometer = kGyroscope + Errors::kMemorySize,
  kMemorySize = kAccelerometer + Errors::kMemorySize
};

/// Angular velocity and specific force at the start of each step with RotorS' errors. The specific
/// force comes from the change of the velocity of the link's centre of mass since the step before.
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
    // As in RotorS, the published variances are those of the densities, not of the samples.
    message.angular_velocity_variance = gyroscope_.density * gyroscope_.density;
    message.specific_force_variance = accelerometer_.density * accelerometer_.density;
    sample.topics.publish(topic_, sample.time + sample.dt, message);
  }

 private:
  Matrix3d R_SF_;
  Vector3d p_FScm_F_;  ///< position of the link's centre of mass [m]
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
      "RotorS' inertial measurement unit: measures every step, from the state one step before the "
      "time stamp",
      {
          T::link("linkName", "link that carries the sensor; its axes are the sensor's axes")
              .must(),
          T::text("imuTopic", "imu", "topic of the messages").from("RotorS"),
          add("gyroscopeNoiseDensity", "rad/s/sqrt(Hz)", "0.0003393695767766752",
              "density of the white noise of the angular velocity"),
          add("gyroscopeBiasRandomWalk", "rad/s^2/sqrt(Hz)", "3.8785094488762879e-05",
              "random walk of the angular velocity's bias"),
          add("gyroscopeBiasCorrelationTime", "s", "1000",
              "correlation time of the angular velocity's bias")
              .above(0)
              .at_most(1e12),
          add("gyroscopeTurnOnBiasSigma", "rad/s", "0.008726646259971648",
              "standard deviation of the bias at turn-on"),
          add("accelerometerNoiseDensity", "m/s^2/sqrt(Hz)", "0.004",
              "density of the white noise of the specific force"),
          add("accelerometerRandomWalk", "m/s^3/sqrt(Hz)", "0.006",
              "random walk of the specific force's bias"),
          add("accelerometerBiasCorrelationTime", "s", "300",
              "correlation time of the specific force's bias")
              .above(0)
              .at_most(1e12),
          add("accelerometerTurnOnBiasSigma", "m/s^2", "0.196",
              "standard deviation of the bias at turn-on"),
          T::choice("noise", {"rotors", "seeded"},
                    "quadcore extension: `rotors` draws the same random numbers in every flight "
                    "and sensor, as RotorS does; `seeded` uses the flight's seed"),
          idle("gyroscopeRandomWalk",
               "RotorS does not read it either, although its vehicles set it; use "
               "gyroscopeBiasRandomWalk"),
          namespace_tag(),
      },
      {},
      create<Imu>,
  };
}

}  // namespace
}  // namespace quadcore::rotors

QUADCORE_REGISTER_PLUGIN(quadcore::rotors::describe)
