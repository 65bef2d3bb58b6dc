#include <algorithm>
#include <cmath>

#include "control/controller.hpp"
#include "control/tags.hpp"
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

/// Flies a law at a rate of its own: reads odometry and reference, commands the rotors.
class ControllerPlugin final : public Plugin {
 public:
  explicit ControllerPlugin(const PluginSetup& setup)
      : law_(setup.parameters.choice("law")),
        values_(control::values_of(setup.parameters, law_tags())),
        spins_(setup.parameters.numbers("spins")),
        rate_(setup.parameters.number("rate")),
        delay_(setup.parameters.number("delay")),
        in_body_(setup.parameters.choice("twistFrame") == "body"),
        rotors_(setup.model.joints.size()) {
    const Parameters& p = setup.parameters;
    odometry_ = setup.topics.takes(p.text("odometry"), messages::kind_of<messages::Odometry>());
    reference_ = setup.topics.takes(p.text("reference"), messages::kind_of<messages::Reference>());
    command_ = setup.topics.publishes(p.text("command"), messages::speeds(rotors_));
    places_ = static_cast<std::size_t>(std::ceil(delay_ * rate_)) + 2;
  }

  std::size_t state_size() const override {
    return kUnderWay + places_ * place_size() + Controller::state_size(law_, rotors_);
  }

  void prepare(const VehicleDescription& vehicle) override {
    controller_ = std::make_unique<Controller>(law_, vehicle, values_, spins_);
  }

  void update(const Sample& sample, PluginState state) const override {
    if (sample.topics[odometry_].count == 0 || sample.topics[reference_].count == 0) return;
    const double per_step = rate_ * sample.dt;
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
    const double delay = state[kSteps] > 0 ? std::ceil(delay_ / sample.dt - rounding) : 0;
    order[0] = state[kSteps] + std::max(delay, 0.0);
    controller_->command(1 / rate_, now, sample.topics.read<messages::Reference>(reference_),
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

  std::string law_;
  control::Values values_;
  std::vector<double> spins_;
  double rate_, delay_;
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
      T::choice("law", names, "the law that is flown"),
      T::number("rate", "1/s", "500", "calls per second; at most one per step").above(0),
      T::number("delay", "s", "0", "from a call to the first step that it commands")
          .at_least(0)
          .at_most(10),
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
