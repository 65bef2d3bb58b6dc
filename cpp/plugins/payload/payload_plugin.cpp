#include <algorithm>
#include <cmath>

#include "quadcore/plugin.hpp"
#include "quadcore/plugin/switch.hpp"

namespace quadcore::payload {
namespace {

/// An attached body: its mass, 0 if none is attached, and its position in the frame.
MessageKind carried_kind() {
  return {"carried",
          {"mass", "x", "y", "z"},
          {},
          "mass of the attached payload, kg, or 0; its position in the frame, m"};
}

/// State: whether the body is attached, once a step has begun.
enum Carrying { as_at_the_start, riding, gone };

/// A body that is attached to the frame until its release or after its pick-up, by time or by
/// topic, whichever is later.
class PayloadPlugin final : public Plugin {
 public:
  explicit PayloadPlugin(const PluginSetup& setup)
      : name_(setup.name),
        pick_up_(event(setup.parameters, "pickUp")),
        release_(event(setup.parameters, "release")),
        topic_(setup.topics.takes(setup.parameters.text("topic"),
                                  switch_kind("riding", rides_at_the_start()))),
        carried_(
            setup.topics.publishes(setup.parameters.text("topic") + "_carried", carried_kind())) {
    const Parameters& p = setup.parameters;
    if (pick_up_ == release_ && p.has("release")) {
      throw InputError("<pickUp> and <release> are at the same time. Use different times.");
    }
    body_.name = name_;
    body_.pose.xyz = Vector3d(p.numbers("xyz").data());
    body_.pose.rpy = Vector3d(p.numbers("rpy").data());
    body_.inertial.mass = p.number("mass");
    const std::vector<double>& I = p.numbers("inertia");
    body_.inertial.inertia << I[0], I[1], I[2], I[1], I[3], I[4], I[2], I[4], I[5];
    check_inertia();
  }

  std::size_t state_size() const override { return 1; }

  void update(const Sample& sample, PluginState state) const override {
    const double now = sample.time + 1e-9;  // the time is a sum of steps
    const bool is_picked_up = now >= pick_up_, is_released = now >= release_;
    const double last = std::max(is_picked_up ? pick_up_ : 0, is_released ? release_ : 0);
    const Topic& said = sample.topics[topic_];
    const double word = said.values.front();
    bool rides = rides_at_the_start();
    if (said.count > 0 && said.stamp >= last) {
      if (word != 0 && word != 1) {
        throw FlightError(sample.time, "topic '" + said.name +
                                           "': riding is neither 1 nor 0. Publish one of them.");
      }
      rides = word == 1;
    } else if (is_picked_up || is_released) {
      rides = !is_released || (is_picked_up && pick_up_ > release_);
    }
    const Carrying carrying = rides ? riding : gone;
    if (state[0] != carrying) publish(sample, rides);
    state[0] = carrying;
  }

  void carried(ConstPluginState state, std::vector<CarriedBody>& bodies) const override {
    const bool rides = state[0] == as_at_the_start ? rides_at_the_start() : state[0] == riding;
    if (rides) bodies.push_back(body_);
  }

 private:
  void publish(const Sample& sample, bool rides) const {
    double* const message = sample.topics.publish(carried_, sample.time);
    message[0] = rides ? body_.inertial.mass : 0;
    std::copy_n(body_.pose.xyz.data(), 3, message + 1);
  }
  static double event(const Parameters& p, const std::string& tag) {
    return p.has(tag) ? p.number(tag) : INFINITY;
  }
  /// Throw InputError for an impossible inertia: a negative moment, or one above the sum of the
  /// others.
  void check_inertia() const {
    const Vector3d moments = body_.inertial.principal_moments();
    const double rounding = 1e-6 * moments[2];
    if (moments[0] >= -rounding && moments[2] <= moments[0] + moments[1] + rounding) return;
    throw InputError(
        "<inertia> is not physically possible: a principal moment is negative or exceeds the sum "
        "of the others. Write ixx ixy ixz iyy iyz izz about the centre of mass.");
  }

  /// Return whether the body is attached at the start, which excludes a body that is picked up
  /// first.
  bool rides_at_the_start() const { return !(pick_up_ < release_); }

  std::string name_;
  CarriedBody body_;
  double pick_up_, release_;  ///< s; infinite if never
  std::size_t topic_, carried_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  return {
      "payload: a body that is attached to the frame, released or picked up",
      {
          T::number("mass", "kg", "", "mass of the payload").must().above(0),
          T::numbers("inertia", "kg m^2", "0 0 0 0 0 0",
                     "ixx ixy ixz iyy iyz izz about the payload's centre of mass, payload axes; "
                     "all 0: a point")
              .of(6),
          T::numbers("xyz", "m", "0 0 0", "payload's centre of mass in the frame").of(3),
          T::numbers("rpy", "rad", "0 0 0", "payload's axes in the frame").of(3),
          T::number("release", "s", "", "time of the release").at_least(0).or_absent("never"),
          T::number("pickUp", "s", "", "time of the pick-up, at rest in the frame")
              .at_least(0)
              .or_absent("attached from the start"),
          T::text(
              "topic", "payload",
              "topic on which 1 attaches and 0 releases the payload at once; the same name with "
              "_carried publishes the attached mass (0 if none) and its position in the frame"),
      },
      {},
      create<PayloadPlugin>,
  };
}

}  // namespace
}  // namespace quadcore::payload

QUADCORE_REGISTER_PLUGIN(quadcore::payload::describe)
