#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "quadcore/plugin.hpp"
#include "quadcore/plugin/counts.hpp"
#include "shared/rotor_shares.hpp"

namespace quadcore::fault {
namespace {

/// The remaining fraction of a rotor's thrust, or of its motor's torque, from a given time on.
struct Event {
  double time;        ///< s
  std::size_t rotor;  ///< counted from 0
  double share;
};

/// Return the events of a tag: time and rotor, and the remaining fraction unless it is always 0.
std::vector<Event> events(const Parameters& p, const std::string& tag, std::size_t numbers,
                          std::size_t rotors) {
  const std::vector<double>& n = p.numbers(tag);
  const std::string row = numbers == 3
                              ? "three numbers for each fault: time, rotor, remaining fraction"
                              : "two numbers for each fault: time, rotor";
  const auto refuse = [&](const std::string& why) { throw InputError("<" + tag + "> " + why); };
  if (n.size() % numbers != 0) {
    refuse("has " + std::to_string(n.size()) + " numbers. Write " + row + ".");
  }
  std::vector<Event> events;
  for (std::size_t i = 0; i < n.size(); i += numbers) {
    const std::string which = "event " + std::to_string(i / numbers + 1);
    const double rotor = n[i + 1], share = numbers == 3 ? n[i + 2] : 0;
    if (n[i] < 0) refuse(which + " is before the start. Use a time >= 0.");
    if (!(rotor >= 1 && rotor <= static_cast<double>(rotors) && rotor == std::floor(rotor))) {
      refuse(which + " names a rotor that does not exist. Use a number from 1 to " +
             std::to_string(rotors) + ".");
    }
    if (!(share >= 0 && share <= 1))
      refuse(which + " has an invalid remaining fraction. Use a number from 0 to 1.");
    const Event event{n[i], static_cast<std::size_t>(rotor) - 1, share};
    for (const Event& other : events) {
      if (other.time == event.time && other.rotor == event.rotor) {
        refuse(which + " repeats rotor " + std::to_string(event.rotor + 1) +
               " at the same time. Keep one of them.");
      }
    }
    events.push_back(event);
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.time < b.time; });
  return events;
}

/// State: whether it has begun, the number of past events of each kind, and the number of processed
/// messages; then the state of each rotor and the time of its last change.
enum Memory { kBegun, kLossesPast, kCutsPast, kFollowed, kRotors };
enum OfRotor { kLost, kSince, kOfRotor };

/// Loss of rotor thrust and motor failures, by time or by topic.
class FaultPlugin final : public Plugin {
 public:
  explicit FaultPlugin(const PluginSetup& setup)
      : rotors_(setup.parameters.joints("rotorJoints").size()),
        losses_(events(setup.parameters, "losses", 3, rotors_)),
        cuts_(events(setup.parameters, "cuts", 2, rotors_)),
        topic_(setup.topics.takes(
            setup.parameters.text("topic"),
            {"fault",
             {"rotor", "effectiveness", "power"},
             {},
             "a rotor, counted from 1, and the fractions that remain from now on"})),
        effectiveness_(
            setup.topics.publishes(setup.parameters.text("effectiveness"),
                                   shares(rotors_, "each rotor's thrust and reaction torque"))),
        power_(setup.topics.publishes(setup.parameters.text("power"),
                                      shares(rotors_, "each motor's torque"))),
        joints_(setup.parameters.joints("rotorJoints")) {
    if (!setup.parameters.has("detection")) return;
    detection_ = setup.parameters.number("detection");
    health_ = setup.topics.publishes(
        setup.parameters.text("health"),
        shares(setup.model.joints.size(), "each rotor's thrust, as detected"));
  }

  std::size_t state_size() const override { return kRotors + kOfRotor * rotors_; }

  void update(const Sample& sample, PluginState state) const override {
    if (state[kBegun] == 0) {
      state[kBegun] = 1;
      for (const std::size_t topic : {effectiveness_, power_}) {
        std::fill_n(sample.topics.publish(topic, sample.time), rotors_, 1.0);
      }
    }
    let_happen(losses_, effectiveness_, sample, state[kLossesPast]);
    let_happen(cuts_, power_, sample, state[kCutsPast]);
    follow(sample, state[kFollowed]);
    if (health_) detect(sample, state);
  }

 private:
  /// Message on one rotor.
  void follow(const Sample& sample, double& followed) const {
    const Topic& said = sample.topics[topic_];
    if (said.count == followed) return;
    if (said.count > followed + 1) {
      throw FlightError(sample.time, "topic '" + said.name +
                                         "': two messages were published in one step, so the first "
                                         "is lost. Publish one per step.");
    }
    followed = said.count;
    const double rotor = said.values[0];
    if (!(rotor >= 1 && rotor <= static_cast<double>(rotors_) && rotor == std::floor(rotor))) {
      throw FlightError(sample.time,
                        "topic '" + said.name +
                            "': this rotor does not exist. Publish a number from 1 to " +
                            std::to_string(rotors_));
    }
    const std::size_t j = static_cast<std::size_t>(rotor) - 1;
    sample.topics.publish(effectiveness_, sample.time)[j] = said.values[1];
    sample.topics.publish(power_, sample.time)[j] = said.values[2];
  }

  /// Publish the state of each rotor to controllers once it has lasted for the detection time.
  void detect(const Sample& sample, PluginState state) const {
    const Topic& health = sample.topics[*health_];
    if (health.count == 0) {
      double* const whole = sample.topics.publish(*health_, sample.time);
      std::fill_n(whole, health.values.size(), 1.0);
    }
    for (std::size_t j = 0; j < rotors_; ++j) {
      const bool is_driven = sample.topics[power_].values[j] > 0;
      const double left = is_driven ? sample.topics[effectiveness_].values[j] : 0;
      auto rotor = state.segment<kOfRotor>(static_cast<Eigen::Index>(kRotors + kOfRotor * j));
      if (rotor[kLost] != 1 - left) rotor << 1 - left, sample.time;
      const bool is_known = health.values[joints_[j]] == left;
      if (is_known || sample.time < rotor[kSince] + detection_ - 1e-9) continue;
      sample.topics.publish(*health_, sample.time)[joints_[j]] = left;
    }
  }

  /// Publish the last values, changed by the events since.
  static void let_happen(const std::vector<Event>& events, std::size_t topic, const Sample& sample,
                         double& past) {
    for (std::size_t i = count_of(past, events.size()); i < events.size(); ++i, ++past) {
      const Event& event = events[i];
      if (sample.time < event.time - 1e-9) return;  // the time is a sum of steps
      sample.topics.publish(topic, sample.time)[event.rotor] = event.share;
    }
  }

  std::size_t rotors_;
  std::vector<Event> losses_, cuts_;  ///< sorted by time
  std::size_t topic_, effectiveness_, power_;
  std::vector<std::size_t> joints_;    ///< joints of the rotors
  std::optional<std::size_t> health_;  ///< topic; none if no controller reads it
  double detection_ = 0;               ///< s
};

PluginDescriptor describe() {
  using T = TagSpec;
  return {
      "rotor faults: loss of thrust and motor failures",
      {
          T::numbers("losses", "s", "",
                     "three numbers for each fault: time, rotor (counted from 1), and the fraction "
                     "of its thrust and reaction torque that remains, 0 to 1")
              .or_absent("none"),
          T::numbers("cuts", "s", "",
                     "two numbers for each motor failure: time and rotor (counted from 1); the "
                     "rotor then turns freely")
              .or_absent("none"),
          T::text("topic", "fault",
                  "topic with a rotor (counted from 1), its effectiveness and its power, which "
                  "take effect at once"),
          effectiveness_tag(),
          T::text("power", "power", "topic that the motor plugin reads"),
          T::number("detection", "s", "", "time from a fault until controllers receive it")
              .at_least(0)
              .or_absent("never"),
          T::text("health", health_topic, "topic that controllers read"),
          T::joints("rotorJoints", "the rotors, in the order in which they are numbered"),
      },
      {},
      create<FaultPlugin>,
  };
}

}  // namespace
}  // namespace quadcore::fault

QUADCORE_REGISTER_PLUGIN(quadcore::fault::describe)
