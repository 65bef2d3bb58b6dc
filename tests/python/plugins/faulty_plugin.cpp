#include <cmath>
#include <quadcore/plugin.hpp>
#include <stdexcept>

namespace {

using quadcore::TagSpec;
using quadcore::Vector3d;

/// Throws where its tag says: an exception, or, where the name ends in "_number", a number. Or does
/// what a plugin must not.
class FaultyPlugin final : public quadcore::Plugin {
 public:
  explicit FaultyPlugin(const quadcore::PluginSetup& setup)
      : fault_(setup.parameters.choice("fault")), after_(setup.parameters.number("after")) {
    throw_in("create", 0);
    if (fault_ == "warning") setup.warnings.push_back("no text: \xff \x1b[31m");
    if (fault_ == "tag") setup.parameters.number("speed");
    if (fault_ == "undeclared") {
      topic_ = setup.topics.takes("vel_cmd", quadcore::messages::speeds(1));
    }
    if (fault_ == "command") {
      topic_ = setup.topics.publishes("vel_cmd", quadcore::messages::speeds(1));
    }
  }

  std::size_t state_size() const override { return fault_ == "state" ? std::size_t(1) << 60 : 1; }
  void update(const quadcore::Sample& sample, quadcore::PluginState state) const override {
    state[0] = sample.time;
    throw_in("update", sample.time);
    if (fault_ == "command" || fault_ == "undeclared") sample.topics.publish(topic_, sample.time);
  }
  void sense(const quadcore::Sample& sample, quadcore::PluginState) const override {
    throw_in("sense", sample.time);
  }
  void air(const quadcore::Kinematics&, quadcore::ConstPluginState state,
           Vector3d& v_WA_W) const override {
    throw_in("air", state[0]);
    if (fault_ == "air_nan" && state[0] >= after_) v_WA_W.y() = NAN;
  }
  void carried(quadcore::ConstPluginState state,
               std::vector<quadcore::CarriedBody>& bodies) const override {
    throw_in("carried", state[0]);
    if (fault_ == "massless" && state[0] >= after_) bodies.push_back({"cargo", {}, {}});
  }
  void forces(const quadcore::Kinematics&, quadcore::ConstPluginState state,
              quadcore::Loads& loads) const override {
    throw_in("forces", state[0]);
    const Vector3d push(0, 1e-3, 0);
    if (state[0] < after_) return;
    if (fault_ == "nan") loads.add_frame_force(0, NAN * push, push);
    if (fault_ == "infinity") loads.add_joint_torque(0, INFINITY);
    if (fault_ == "rotor_force") loads.add_rotor_force(0, 99, push);
    if (fault_ == "rotor_torque") loads.add_joint_torque(99, 1e-3);
    if (fault_ == "term_force") loads.add_frame_force(5, push, push);
    if (fault_ == "term_torque") loads.add_frame_torque(1, push);
  }

 private:
  void throw_in(const std::string& hook, double time) const {
    if (time < after_) return;
    if (fault_ == hook) throw std::runtime_error("out of\nluck");
    if (fault_ == hook + "_number") throw 13;
  }

  std::string fault_;
  double after_;  ///< s
  std::size_t topic_ = 0;
};

quadcore::PluginDescriptor describe() {
#ifdef DESCRIBE_THROWS
  throw std::runtime_error("what am I?");
#endif
  return {
      "throws",
      {TagSpec::choice("fault",
                       {"none",     "create",      "create_number", "warning",    "null",
                        "tag",      "update",      "update_number", "forces",     "forces_number",
                        "air",      "air_number",  "air_nan",       "carried",    "carried_number",
                        "massless", "sense",       "sense_number",  "state",      "nan",
                        "infinity", "rotor_force", "rotor_torque",  "term_force", "term_torque",
                        "command",  "undeclared"},
                       "where"),
       TagSpec::number("after", "s", "0", "not before this time")},
#ifdef NAMED_TWICE
      {"fault", "fault"},
#else
      {"fault"},
#endif
#ifdef WITHOUT_CREATE
      {nullptr},
#else
      {[](const quadcore::PluginSetup& setup) -> std::unique_ptr<quadcore::Plugin> {
         if (setup.parameters.choice("fault") == "null") return nullptr;
         return std::make_unique<FaultyPlugin>(setup);
       },
#ifdef OLD_LAWS
       {true, true, true, true, true, true, true, "of old"}
#endif
      },
#endif
  };
}

}  // namespace

#ifdef WITHOUT_DESCRIPTOR
extern "C" {
extern const quadcore::PluginModule quadcore_plugin;
const quadcore::PluginModule quadcore_plugin = {
    quadcore::plugin_interface, []() -> const quadcore::PluginDescriptor* { return nullptr; }};
}
#else
QUADCORE_REGISTER_PLUGIN(describe)
#endif
