#include <cmath>

#include "gps/earth.hpp"
#include "naming.hpp"
#include "noise.hpp"
#include "quadcore/plugin.hpp"
#include "quadcore/plugin/error.hpp"
#include "shared/sensing.hpp"

namespace quadcore::rotors {
namespace {

/// State: time of measurement and number of random numbers drawn.
enum Memory { kSamples, kDraws, kMemorySize };

/// Return the SDF tag of the noise on a sensor's position.
std::string noise_tag(const std::string& quantity, const std::string& direction,
                      const std::string& what) {
  return "sensor/gps/" + quantity + "_sensing/" + direction + "/noise/" + what;
}

/// A GPS receiver: Gazebo's sensor adds noise to the position, RotorS' module to the velocity, both
/// in world axes.
class Gps final : public Plugin {
 public:
  explicit Gps(const PluginSetup& setup)
      : p_FS_F_(antenna(setup)),
        rate_(setup.parameters.number("sensor/update_rate")),
        each_step_(setup.parameters.number("sensor/update_rate") == 0),
        earth_(checked(setup.world.origin)),
        place_noise_(along(setup, noise_tag("position", "horizontal", "stddev"),
                           noise_tag("position", "vertical", "stddev"))),
        velocity_noise_(along(setup, "horVelStdDev", "verVelStdDev")),
        deviation_(along(setup, "horPosStdDev", "verPosStdDev")),
        fix_(setup.topics.publishes(topic_of(setup, "gpsTopic"),
                                    messages::kind_of<messages::Fix>())),
        speed_(setup.topics.publishes(topic_of(setup, "groundSpeedTopic"),
                                      messages::kind_of<messages::GroundSpeed>())) {}

  std::size_t state_size() const override { return kMemorySize; }

  void sense(const Sample& sample, PluginState state) const override {
    if (!each_step_ && !rate_.is_due(sample, state[kSamples])) return;
    const Kinematics& k = sample.kinematics;
    const auto draw = [&](const Vector3d& deviation) {
      Vector3d error;
      for (int i = 0; i < 3; ++i) error[i] = normal_of(deviation[i], sample.seed, state[kDraws]);
      return error;
    };
    messages::Fix fix;
    fix.position = k.p_WF + k.R_WF * p_FS_F_ + draw(place_noise_);
    fix.velocity = k.v_WS_W(p_FS_F_) + draw(velocity_noise_);
    earth_.locate(fix);
    fix.horizontal_variance = deviation_.x() * deviation_.x();
    fix.vertical_variance = deviation_.z() * deviation_.z();
    fix.velocity_variance = velocity_noise_.cwiseAbs2().maxCoeff();
    sample.topics.publish(fix_, sample.time, fix);
    sample.topics.publish(speed_, sample.time, messages::GroundSpeed{fix.velocity});
  }

 private:
  static Vector3d antenna(const PluginSetup& setup) {
    const Pose X_FS = place_of(setup, "linkName");
    return X_FS.xyz + X_FS.rotation() * vector_of(setup.parameters, "sensor/pose");
  }

  static const Origin& checked(const Origin& origin) {
    if (origin.heading != 0) {
      throw InputError(
          "the world's <heading_deg> is not 0, and a rotation from east and north is not modelled. "
          "Write 0.");
    }
    if (std::abs(origin.latitude) > 89) {
      throw InputError(
          "the world's <latitude_deg> is at a pole, where east is undefined. Use a latitude from "
          "-89 to 89.");
    }
    return origin;
  }

  static Vector3d along(const PluginSetup& setup, const std::string& horizontal,
                        const std::string& vertical) {
    const double level = setup.parameters.number(horizontal);
    return {level, level, setup.parameters.number(vertical)};
  }

  Vector3d p_FS_F_;  ///< position of the antenna [m]
  sensing::Rate rate_;
  bool each_step_;
  gps::Earth earth_;
  Vector3d place_noise_, velocity_noise_, deviation_;  ///< standard deviations [m], [m/s], [m]
  std::size_t fix_, speed_;                            ///< topics
};

PluginDescriptor describe() {
  using T = TagSpec;
  const auto deviation = [](const std::string& name, const char* unit, const char* fallback,
                            const std::string& of) {
    return T::number(name, unit, fallback, "standard deviation of " + of).at_least(0);
  };
  std::vector<TagSpec> tags = {
      T::link("linkName", "link that carries the sensor").must(),
      T::text("gpsTopic", "gps", "topic of the positions"),
      T::text("groundSpeedTopic", "ground_speed", "topic of the velocities"),
      deviation(
          "horPosStdDev", "m", "3",
          "each of x and y as stated in the messages; the tags of <sensor> set the noise itself"),
      deviation("verPosStdDev", "m", "6", "z as stated in the messages"),
      deviation("horVelStdDev", "m/s", "0.1", "the noise on the velocity along each of x and y"),
      deviation("verVelStdDev", "m/s", "0.1", "the noise on the velocity along z"),
  };
  for (TagSpec& tag : tags) tag.equation = "RotorS";
  tags.push_back(namespace_tag());
  std::vector<TagSpec> of_sensor = {
      T::numbers("sensor/pose", "m, rad", "0 0 0 0 0 0", "pose of the antenna in the link").of(6),
      T::number("sensor/update_rate", "1/s", "0",
                "messages per second, at most one per step; 0: every step")
          .at_least(0),
  };
  for (const char* idle_tag : {"always_on", "visualize", "topic"}) {
    of_sensor.push_back(idle("sensor/" + std::string(idle_tag), "the sensor is always on"));
  }
  for (const char* direction : {"horizontal", "vertical"}) {
    const std::string axes = direction == std::string("vertical") ? "z" : "each of x and y";
    of_sensor.push_back(deviation(noise_tag("position", direction, "stddev"), "m", "0",
                                  "the noise on the position along " + axes));
    of_sensor.push_back(
        T::choice(noise_tag("position", direction, "type"), {"gaussian"}, "type of this noise"));
    for (const char* what : {"mean", "bias_mean", "bias_stddev"}) {
      of_sensor.push_back(T::number(noise_tag("position", direction, what), "m", "0",
                                    "constant error, which is not modelled")
                              .at_least(0)
                              .at_most(0));
    }
  }
  for (const char* direction : {"horizontal", "vertical"}) {
    for (const char* what : {"stddev", "type", "mean", "bias_mean", "bias_stddev"}) {
      of_sensor.push_back(
          idle(noise_tag("velocity", direction, what),
               "RotorS uses the link's velocity with horVelStdDev and verVelStdDev"));
    }
  }
  for (TagSpec& tag : of_sensor) {
    tag.equation = "SDF";
    tags.push_back(tag);
  }
  return {
      "RotorS' GPS receiver, including the Gazebo sensor that contains it", tags, {}, create<Gps>};
}

}  // namespace
}  // namespace quadcore::rotors

QUADCORE_REGISTER_PLUGIN(quadcore::rotors::describe)
