#include <fstream>
#include <quadcore/plugin.hpp>

namespace {

using quadcore::MessageKind;
using quadcore::TagSpec;
namespace messages = quadcore::messages;

MessageKind kind_named(const std::string& name) {
  if (name == messages::Odometry::kind) return messages::kind_of<messages::Odometry>();
  if (name == messages::Imu::kind) return messages::kind_of<messages::Imu>();
  if (name == messages::Wrench::kind) return messages::kind_of<messages::Wrench>();
  if (name == messages::Vector::kind) return messages::kind_of<messages::Vector>();
  return {"relay", {"a", "b"}};  // its own
}

/// Hands a topic on: publishes at each step what it takes, times a gain, plus the time, a number of
/// its own and one of a file, and turns rotor 0 with the first of what it takes.
class RelayPlugin final : public quadcore::Plugin {
 public:
  explicit RelayPlugin(const quadcore::PluginSetup& setup)
      : gain_(setup.parameters.number("gain")),
        takes_(setup.parameters.has("takes")),
        publishes_(setup.parameters.has("publishes")) {
    own_ = setup.parameters.numbers("own");
    std::ifstream file(setup.parameters.file("table"));
    for (double number; file >> number;) table_.push_back(number);
    const MessageKind kind = kind_named(setup.parameters.choice("kind"));
    quadcore::Topics& topics = setup.topics;
    if (takes_) {
      in_ = topics.takes(setup.parameters.text("takes"), kind, setup.parameters.flag("late"));
    }
    if (publishes_) out_ = topics.publishes(setup.parameters.text("publishes"), kind);
  }

  std::size_t state_size() const override { return 1; }

  void update(const quadcore::Sample& sample, quadcore::PluginState state) const override {
    if (takes_) state[0] = sample.topics[in_].values[0];
    if (!publishes_) return;
    double* const values = sample.topics.publish(out_, sample.time);
    for (std::size_t i = 0; i < sample.topics[out_].values.size(); ++i) {
      values[i] = (takes_ ? gain_ * sample.topics[in_].values[i] : 0) + sample.time;
      if (i < own_.size()) values[i] += own_[i];
      if (i < table_.size()) values[i] += table_[i];
    }
  }

  void forces(const quadcore::Kinematics&, quadcore::ConstPluginState state,
              quadcore::Loads& loads) const override {
    loads.add_joint_torque(0, 1e-4 * state[0]);
  }

 private:
  double gain_;
  std::vector<double> own_, table_;
  bool takes_, publishes_;
  std::size_t in_ = 0, out_ = 0;
};

quadcore::PluginDescriptor describe() {
  return {
      "hands a topic on",
      {TagSpec::text("takes", "", "topic").or_absent("none"),
       TagSpec::text("publishes", "", "topic").or_absent("none"),
       TagSpec::choice("kind",
                       {"relay", messages::Odometry::kind, messages::Imu::kind,
                        messages::Wrench::kind, messages::Vector::kind},
                       "of both"),
       TagSpec::flag("late", "false", "whether it takes its topic a sample late"),
       TagSpec::number("gain", "", "1", "factor"),
       TagSpec::numbers("own", "", "0 0", "for the first two numbers").of(2).at_most(100),
       TagSpec::file("table", "numbers for the first ones")},
      {},
      quadcore::create<RelayPlugin>,
  };
}

}  // namespace

QUADCORE_REGISTER_PLUGIN(describe)
