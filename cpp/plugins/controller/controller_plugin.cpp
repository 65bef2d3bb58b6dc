#include <algorithm>
#include <cmath>

#include "control/tags.hpp"
#include "quadcore/control/controller.hpp"
#include "quadcore/control/gains_file.hpp"
#include "quadcore/control/second_vehicle.hpp"
#include "quadcore/plugin.hpp"

namespace quadcore::controller {
namespace {

using control::Controller;

constexpr double rounding = 1e-6;  ///< of a period

const std::vector<TagSpec>& law_tags() {
  static const std::vector<TagSpec> tags = [] {
    std::vector<std::pair<std::string, std::vector<TagSpec>>> tables;
    for (const control::LawInfo& law : control::laws()) {
      tables.emplace_back(law.name, Controller::table(law.name));
    }
    return control::tags_of(tables);
  }();
  return tags;
}

/// What the tags ask for; what they leave open is that of the gains file.
control::Gains chosen(const Parameters& tags) {
  control::Gains gains;
  if (tags.has("gains")) {
    gains = control::read_gains(tags.file("gains"));
    if (tags.has("law") && tags.choice("law") != gains.law) {
      throw InputError("<law> is " + tags.choice("law") + ", but the gains of " +
                       tags.text("gains") + " are those of " + gains.law + "; leave <law> out");
    }
  } else if (tags.has("law")) {
    gains.law = tags.choice("law");
  } else {
    throw InputError("no law is named; write <law> or <gains>");
  }
  if (tags.has("rate")) gains.rate = tags.number("rate");
  if (tags.has("delay")) gains.delay = tags.number("delay");
  gains.values = control::completed(control::values_of(tags, law_tags()), gains.values);
  return gains;
}

/// Flies a law at a rate of its own: reads odometry and reference, commands the rotors.
class ControllerPlugin final : public Plugin {
 public:
  explicit ControllerPlugin(const PluginSetup& setup)
      : gains_(chosen(setup.parameters)),
        spins_(setup.parameters.numbers("spins")),
        believed_(setup.parameters.file("belief")),
        in_body_(setup.parameters.choice("twistFrame") == "body"),
        rotors_(setup.model.joints.size()) {
    const Parameters& p = setup.parameters;
    odometry_ = setup.topics.takes(p.text("odometry"), messages::kind_of<messages::Odometry>());
    reference_ = setup.topics.takes(p.text("reference"), messages::kind_of<messages::Reference>());
    command_ = setup.topics.publishes(p.text("command"), messages::speeds(rotors_));
    places_ = static_cast<std::size_t>(std::ceil(gains_.delay * gains_.rate)) + 2;
  }

  std::size_t state_size() const override {
    return kUnderWay + places_ * place_size() + Controller::state_size(gains_.law, rotors_);
  }

  void prepare(const VehicleDescription& vehicle) override {
    const VehicleDescription believed =
        believed_.empty() ? vehicle : control::second_vehicle(believed_, vehicle);
    controller_ = std::make_unique<Controller>(gains_.law, believed, gains_.values, spins_);
  }

  void update(const Sample& sample, PluginState state) const override {
    if (sample.topics[odometry_].count == 0 || sample.topics[reference_].count == 0) return;
    const double per_step = gains_.rate * sample.dt;
    // By the count of steps: the sum of their times would slip.
    const double due = std::floor(state[kSteps] * per_step + rounding) + 1;
    if (due > state[kAsked]) {
      state[kAsked] = due;
      ask(sample, state);
    }
    arrive(sample, state);
    state[kSteps] += 1;
  }

 private:
  /// Steps flown, periods asked plus one, commands sent and commands that arrived; then a ring of
  /// commands under way, each the step of its arrival and the speeds; then the controller's.
  enum Memory { kSteps, kAsked, kSent, kArrived, kUnderWay };

  std::size_t place_size() const { return 1 + rotors_; }
  double* place(PluginState& state, double count) const {
    const auto index = static_cast<std::size_t>(std::fmod(count, static_cast<double>(places_)));
    return state.data() + kUnderWay + index * place_size();
  }

  void ask(const Sample& sample, PluginState& state) const {
    auto now = sample.topics.read<messages::Odometry>(odometry_);
    if (in_body_) now.linear_velocity = now.orientation * now.linear_velocity;
    double* const order = place(state, state[kSent]);
    // The first command acts at once, for nothing precedes it.
    const double delay = state[kSteps] > 0 ? std::ceil(gains_.delay / sample.dt - rounding) : 0;
    order[0] = state[kSteps] + std::max(delay, 0.0);
    const double period = std::max(1 / gains_.rate, sample.dt);  // called once a step at most
    controller_->command(period, now, sample.topics.read<messages::Reference>(reference_),
                         state.data() + kUnderWay + places_ * place_size(), order + 1);
    state[kSent] += 1;
  }

  void arrive(const Sample& sample, PluginState& state) const {
    while (state[kArrived] < state[kSent]) {
      const double* const order = place(state, state[kArrived]);
      if (order[0] > state[kSteps]) return;
      std::copy_n(order + 1, rotors_, sample.topics.publish(command_, sample.time));
      state[kArrived] += 1;
    }
  }

  control::Gains gains_;
  std::vector<double> spins_;
  std::string believed_;  ///< path of the vehicle that is believed to fly; "": what flies
  bool in_body_;
  std::size_t rotors_, places_;
  std::size_t odometry_, reference_, command_;
  std::unique_ptr<const Controller> controller_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  std::vector<std::string> names;
  for (const control::LawInfo& law : control::laws()) names.push_back(law.name);
  std::vector<TagSpec> tags = {
      T::choice("law", names, "the law that is flown").or_absent("that of the gains"),
      T::file("gains", "a gains file; what other tags set wins")
          .or_absent("every parameter at its default"),
      T::number("rate", "1/s", "", "calls per second; at most one per step")
          .above(0)
          .or_absent("that of the gains, or 500"),
      T::number("delay", "s", "", "from a call to the first step that it commands")
          .at_least(0)
          .at_most(control::longest_delay)
          .or_absent("that of the gains, or 0"),
      T::file("belief",
              "URDF of the vehicle that the law believes to fly; of its plugins only "
              "what exerts forces is asked")
          .or_absent("what flies"),
      T::numbers("spins", "", "", "1 or -1: the sense in which each rotor turns about its axis")
          .or_absent("neighbours around the vehicle turn against each other"),
      T::choice("twistFrame", {"world", "body"}, "axes of the odometry's linear velocity").agreed(),
      T::text("odometry", "odom", "topic of what is measured"),
      T::text("reference", "reference", "topic of where the vehicle is to be"),
      T::text("command", "vel_cmd", "topic of the rotors' speeds"),
  };
  tags.insert(tags.end(), law_tags().begin(), law_tags().end());
  return {"flies a control law", tags, {}, create<ControllerPlugin>};
}

}  // namespace
}  // namespace quadcore::controller

QUADCORE_REGISTER_PLUGIN(quadcore::controller::describe)
