#include "quadcore/plugin.hpp"
#include "shared/beam.hpp"
#include "shared/mounted_sensor.hpp"
#include "shared/noise_and_drift.hpp"

namespace quadcore::range {
namespace {

using Errors = sensing::NoiseAndDrift<1>;

/// Distance from a link's origin to the ground or an obstacle along the link's x axis.
class RangePlugin final : public sensing::MountedSensor<messages::Range, Errors::kMemorySize> {
 public:
  explicit RangePlugin(const PluginSetup& setup)
      : MountedSensor(setup),
        p_FS_F_(mounting(setup).xyz),
        beam_F_(mounting(setup).rotation() * Vector3d::UnitX()),
        limits_(setup.parameters),
        errors_(setup.parameters) {
    sensing::warn_of_undetected(setup);
  }

 private:
  std::optional<messages::Range> measure(const Sample& sample, PluginState memory) const override {
    const Kinematics& k = sample.kinematics;
    const Ray ray{k.p_WF + k.R_WF * p_FS_F_, k.R_WF * beam_F_};
    const double error = errors_.next(sample, memory).value();
    return messages::Range{limits_.measure(ray, sample.world, error), limits_.minimum,
                           limits_.maximum};
  }

  Vector3d p_FS_F_;  ///< position of the link's origin [m]
  Vector3d beam_F_;  ///< direction of the beam
  sensing::RangeLimits limits_;
  Errors errors_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  std::vector<TagSpec> tags = {
      T::link("link", "link that carries the sensor; the beam leaves its origin along its x axis"),
      T::number("rate", "1/s", "50", "messages per second; at most one per step").above(0),
      T::text("topic", "range", "topic of the messages"),
      sensing::RangeLimits::minimum_tag(),
      sensing::RangeLimits::maximum_tag("10"),
  };
  Errors::add_tags(tags, "m", "the distance");
  tags.push_back(sensing::Channel::delay_tag());
  tags.push_back(sensing::Channel::dropout_tag());
  return {"range sensor: distance along one beam", tags, {}, create<RangePlugin>};
}

}  // namespace
}  // namespace quadcore::range

QUADCORE_REGISTER_PLUGIN(quadcore::range::describe)
