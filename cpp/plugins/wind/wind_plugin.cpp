#include <cstring>
#include <type_traits>

#include "dryden.hpp"
#include "mean_wind.hpp"
#include "quadcore/plugin.hpp"

namespace quadcore::wind {
namespace {

constexpr std::size_t turbulence_numbers = sizeof(Turbulence) / sizeof(double);
static_assert(std::is_trivially_copyable_v<Turbulence> &&
              turbulence_numbers * sizeof(double) == sizeof(Turbulence));

/// State: whether a message has set the mean wind, the mean wind that it set, the turbulence of
/// this step, and the filters.
enum Memory { kIsSet, kSet, kAir = kSet + 3, kFilters = kAir + 3 };

/// Mean wind, gusts and turbulence at the frame's position.
class WindPlugin final : public Plugin {
 public:
  explicit WindPlugin(const PluginSetup& setup)
      : velocity_W_(setup.parameters.numbers("velocity").data()),
        shear_(setup.parameters),
        gusts_(Gust::all(setup.parameters)),
        turbulent_(setup.parameters.number("turbulence") > 0),
        scales_(
            low_altitude(setup.parameters.number("height"), setup.parameters.number("turbulence"))),
        airspeed_(setup.parameters.number("airspeed")),
        topic_(setup.topics.publishes(
            setup.parameters.text("topic"),
            messages::kind_of<messages::Vector>(messages::WindSpeed::meaning))),
        velocity_topic_(setup.topics.takes(
            setup.parameters.text("velocityTopic"),
            messages::kind_of<messages::Vector>("mean velocity of the air, world axes, m/s"))) {
    if (!shear_.acts() || !velocity_W_.isZero(0)) return;
    setup.warnings.push_back(
        "<shear> has no effect while <velocity> is 0, unless a message on <velocityTopic> sets the "
        "wind; write the wind at <referenceHeight>");
  }

  std::size_t state_size() const override { return kFilters + turbulence_numbers; }

  void update(const Sample& sample, PluginState state) const override {
    if (sample.topics[velocity_topic_].count > 0) {
      state[kIsSet] = 1;
      state.segment<3>(kSet) = sample.topics.read<messages::Vector>(velocity_topic_).value;
    }
    if (!turbulent_) return;
    Turbulence turbulence;
    std::memcpy(&turbulence, state.data() + kFilters, sizeof turbulence);
    if (turbulence.begun == 0) {
      const Kinematics& k = sample.kinematics;
      turbulence.begin(scales_, mean_W(k, {state.data(), state.size()}) - k.R_WF * k.v_WF_F,
                       airspeed_, sample.dt, sample.seed);
    } else {
      turbulence.advance(sample.seed);
    }
    std::memcpy(state.data() + kFilters, &turbulence, sizeof turbulence);
    state.segment<3>(kAir) = turbulence.v_WA_W(scales_);
  }

  void air(const Kinematics& kinematics, ConstPluginState state, Vector3d& v_WA_W) const override {
    v_WA_W += mean_W(kinematics, state);
    for (const Gust& gust : gusts_) gust.blow(kinematics.time, v_WA_W);
    if (turbulent_) v_WA_W += state.segment<3>(kAir);
  }

  void sense(const Sample& sample, PluginState state) const override {
    messages::Vector v_WA_W;
    air(sample.kinematics, {state.data(), state.size()}, v_WA_W.value);
    sample.topics.publish(topic_, sample.time, v_WA_W);
  }

 private:
  Vector3d mean_W(const Kinematics& kinematics, ConstPluginState state) const {
    const Vector3d velocity_W = state[kIsSet] != 0 ? Vector3d(state.segment<3>(kSet)) : velocity_W_;
    if (!shear_.acts()) return velocity_W;
    return shear_.factor(kinematics.p_WF.z()) * velocity_W;
  }

  Vector3d velocity_W_;  ///< until a message sets another one [m/s]
  Shear shear_;
  std::vector<Gust> gusts_;
  bool turbulent_;
  DrydenScales scales_;
  double airspeed_;  ///< m/s
  std::size_t topic_;
  std::size_t velocity_topic_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  const std::string mil = "MIL-F-8785C 3.7.3";
  return {
      "wind: mean, shear, gusts and turbulence; acts with <dragModel> chapter2, not with appendix",
      {
          T::numbers("velocity", "m/s", "0 0 0", "mean velocity of the air, world axes").of(3),
          T::choice("shear", {"none", "power", "logarithmic"},
                    "growth of the mean wind with the height above the world's z = 0: none, "
                    "(z/referenceHeight)^exponent, ln(z/roughness)/ln(referenceHeight/roughness)")
              .from(mil + ".2"),
          T::number("referenceHeight", "m", "6.096",
                    "height at which the mean wind is <velocity>; 20 ft")
              .above(0)
              .from(mil + ".2"),
          T::number("exponent", "", "0.14285714285714285", "exponent of shear power").at_least(0),
          T::number("roughness", "m", "0.04572",
                    "roughness length of shear logarithmic, below which the air is still; 0.04572 "
                    "(0.15 ft) on an airfield, 0.6096 (2 ft) elsewhere")
              .above(0)
              .from(mil + ".2"),
          T::numbers("gusts", "m/s m/s m/s s s", "",
                     "five numbers for each gust: maximum velocity along the world's x, y, z, "
                     "start, duration; V/2 (1 - cos(2 pi (t - start)/duration))")
              .or_absent("none"),
          T::number("turbulence", "m/s", "0",
                    "wind speed at 20 ft that defines the turbulence, W20: 7.717 light (15 kt), "
                    "15.433 moderate, 23.15 severe, 0 none")
              .at_least(0)
              .from(mil),
          T::number("height", "m", "10", "height at which the turbulence is evaluated")
              .at_least(3.048)
              .at_most(304.8)
              .from(mil),
          T::number("airspeed", "m/s", "5",
                    "minimum speed at which turbulence passes the vehicle; the relative speed of "
                    "the mean wind at the start of the flight applies if it is larger")
              .above(0),
          T::text("topic", "wind", "topic of the air velocity, world axes"),
          T::text("velocityTopic", "wind_velocity",
                  "topic of a mean velocity that replaces <velocity>"),
      },
      {},
      create<WindPlugin>,
  };
}

}  // namespace
}  // namespace quadcore::wind

QUADCORE_REGISTER_PLUGIN(quadcore::wind::describe)
