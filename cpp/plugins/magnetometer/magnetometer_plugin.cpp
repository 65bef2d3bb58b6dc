#include "quadcore/plugin.hpp"
#include "shared/noise_and_drift.hpp"
#include "shared/sensing.hpp"

namespace quadcore::magnetometer {
namespace {

using Errors = sensing::NoiseAndDrift<3>;

/// What it remembers: when it measured, its errors, what is on the way.
enum Memory { kSamples, kErrors, kChannel = kErrors + Errors::kMemorySize };

/// The world's magnetic field, which is the same everywhere, in the axes of a link of the frame.
class MagnetometerPlugin final : public Plugin {
 public:
  explicit MagnetometerPlugin(const PluginSetup& setup)
      : R_FS_(setup.model.pose_of_link.at(setup.parameters.choice("link")).rotation()),
        rate_(setup.parameters.number("rate")),
        errors_(setup.parameters),
        channel_(setup,
                 setup.topics.publishes(setup.parameters.text("topic"),
                                        messages::kind_of<messages::Field>()),
                 messages::kind_of<messages::Field>(), setup.parameters.number("rate")) {}

  std::size_t state_size() const override { return kChannel + channel_.state_size(); }

  void sense(const Sample& sample, PluginState state) const override {
    PluginState on_the_way(state.data() + kChannel, state.size() - kChannel);
    if (rate_.is_due(sample, state[kSamples])) {
      const Matrix3d R_WS = sample.kinematics.R_WF * R_FS_;
      const Vector3d B_S = R_WS.transpose() * sample.world.magnetic_field_W;
      const auto error = errors_.next(sample, state.segment<Errors::kMemorySize>(kErrors));
      channel_.send(sample, sample.seed, on_the_way,
                    messages::Field{B_S + error, errors_.variance().x()});
    }
    channel_.deliver(sample, on_the_way);
  }

 private:
  Matrix3d R_FS_;  ///< of the link in the frame
  sensing::Rate rate_;
  Errors errors_;
  sensing::Channel channel_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  std::vector<TagSpec> tags = {
      T::link("link", "where it is mounted; its axes are the unit's"),
      T::number("rate", "1/s", "50", "messages per second; at most one per step").above(0),
      T::text("topic", "magnetic_field", "where the messages are published"),
  };
  Errors::add_tags(tags, "T", "each component of the field");
  tags.push_back(sensing::Channel::delay_tag());
  tags.push_back(sensing::Channel::dropout_tag());
  return {"a magnetometer on a link of the frame", tags, {}, create<MagnetometerPlugin>};
}

}  // namespace
}  // namespace quadcore::magnetometer

QUADCORE_REGISTER_PLUGIN(quadcore::magnetometer::describe)
