#include <quadcore/plugin.hpp>

namespace {

using quadcore::TagSpec;
using quadcore::Vector3d;

/// Adds a gust V (1 - cos(2 pi (t - begin)/duration))/2, or a steady wind V without a duration.
class GustPlugin final : public quadcore::Plugin {
 public:
  explicit GustPlugin(const quadcore::PluginSetup& setup)
      : V_W_(setup.parameters.number("x"), setup.parameters.number("y"),
             setup.parameters.number("z")),
        begin_(setup.parameters.number("begin")),
        duration_(setup.parameters.has("duration") ? setup.parameters.number("duration") : 0) {}

  void air(const quadcore::Kinematics& kinematics, quadcore::ConstPluginState,
           Vector3d& v_WA_W) const override {
    if (duration_ == 0) {
      v_WA_W += V_W_;
      return;
    }
    const double t = kinematics.time - begin_;
    if (t <= 0 || t >= duration_) return;
    v_WA_W += (1 - quadcore::elementary::cos(6.283185307179586 * t / duration_)) / 2 * V_W_;
  }

 private:
  Vector3d V_W_;             ///< m/s
  double begin_, duration_;  ///< s
};

quadcore::PluginDescriptor describe() {
  return {
      "gust of the shape 1 - cos, or a steady wind",
      {TagSpec::number("x", "m/s", "0", "maximum velocity of the air along the world's x"),
       TagSpec::number("y", "m/s", "0", "along the world's y"),
       TagSpec::number("z", "m/s", "0", "along the world's z"),
       TagSpec::number("begin", "s", "0", "start of the gust"),
       TagSpec::number("duration", "s", "", "length of the gust")
           .above(0)
           .or_absent("a steady wind")},
      {},
      quadcore::create<GustPlugin>,
  };
}

}  // namespace

QUADCORE_REGISTER_PLUGIN(describe)
