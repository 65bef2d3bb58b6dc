#include <cmath>
#include <vector>

#include "quadcore/plugin.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/random.hpp"
#include "shared/beam.hpp"
#include "shared/sensing.hpp"

namespace quadcore::lidar {
namespace {

/// Distances from a link's origin to the ground and obstacles, along beams in the link's x-y plane.
class LidarPlugin final : public Plugin {
 public:
  explicit LidarPlugin(const PluginSetup& setup)
      : mounting_(setup.model.pose_of_link.at(setup.parameters.choice("link"))),
        limits_(setup.parameters),
        first_(setup.parameters.number("minAngle")),
        beams_(count_beams(setup.parameters)),
        increment_(beams_ > 1 ? (setup.parameters.number("maxAngle") - first_) /
                                    static_cast<double>(beams_ - 1)
                              : 0),
        noise_(setup.parameters.number("noise")),
        rate_(setup.parameters.number("rate")),
        channel_(setup, messages::scan(beams_)) {
    const Matrix3d R_FS = mounting_.rotation().toRotationMatrix();
    for (std::size_t i = 0; i < beams_; ++i) {
      const double angle = first_ + static_cast<double>(i) * increment_;
      beams_F_.push_back(R_FS * Vector3d(elementary::cos(angle), elementary::sin(angle), 0));
    }
    sensing::warn_of_undetected(setup);
  }

  std::size_t state_size() const override { return kChannel + channel_.state_size(); }

  void sense(const Sample& sample, PluginState state) const override {
    PluginState on_the_way(state.data() + kChannel, state.size() - kChannel);
    if (rate_.is_due(sample, state[kSamples])) {
      channel_.send_row(sample, on_the_way,
                        [&](double* row) { measure(sample, state[kDraws], row); });
    }
    channel_.deliver(sample, on_the_way);
  }

 private:
  /// Time of measurement and number of random numbers drawn; then the messages in the Channel.
  enum Memory { kSamples, kDraws, kChannel };

  static std::size_t count_beams(const Parameters& p) {
    const double samples = p.number("samples");
    if (samples != std::floor(samples)) {
      throw InputError("<samples> is not a whole number. Write the number of beams.");
    }
    if (p.number("maxAngle") < p.number("minAngle")) {
      throw InputError("<maxAngle> is below <minAngle>. Exchange them.");
    }
    return static_cast<std::size_t>(samples);
  }

  void measure(const Sample& sample, double& draws, double* row) const {
    const Kinematics& k = sample.kinematics;
    const Vector3d p_WS = k.p_WF + k.R_WF * mounting_.xyz;
    for (const double number : {first_, increment_, limits_.minimum, limits_.maximum}) {
      *row++ = number;
    }
    for (const Vector3d& beam_F : beams_F_) {
      const double error = noise_ > 0 ? noise_ * random_normal(sample.seed, draws) : 0;
      *row++ = limits_.measure({p_WS, k.R_WF * beam_F}, sample.world, error);
    }
  }

  Pose mounting_;  ///< of the link in the frame
  sensing::RangeLimits limits_;
  double first_;  ///< angle of the first beam [rad]
  std::size_t beams_;
  double increment_;  ///< rad
  std::vector<Vector3d> beams_F_;
  double noise_;  ///< m
  sensing::Rate rate_;
  sensing::Channel channel_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  return {
      "lidar: distances along beams in a plane",
      {
          T::link("link", "link that carries the sensor; angles are about its z axis, from x to y"),
          T::number("rate", "1/s", "10", "messages per second; at most one per step").above(0),
          T::text("topic", "scan", "topic of the messages"),
          T::number("samples", "", "181",
                    "number of beams, at equal angles from the first to the "
                    "last")
              .at_least(1)
              .at_most(10000),
          T::number("minAngle", "rad", "-1.5707963267948966", "angle of the first beam"),
          T::number("maxAngle", "rad", "1.5707963267948966", "angle of the last beam"),
          sensing::RangeLimits::minimum_tag(),
          sensing::RangeLimits::maximum_tag("30"),
          T::number("noise", "m", "0", "standard deviation of the white noise of each distance")
              .at_least(0),
          sensing::Channel::delay_tag(),
          sensing::Channel::dropout_tag(),
      },
      {},
      create<LidarPlugin>,
  };
}

}  // namespace
}  // namespace quadcore::lidar

QUADCORE_REGISTER_PLUGIN(quadcore::lidar::describe)
