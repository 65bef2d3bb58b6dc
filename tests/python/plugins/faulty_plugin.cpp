#include <quadcore/plugin.hpp>
#include <stdexcept>

namespace {

using quadcore::TagSpec;

/// Throws where its tag says: an exception, or, where the name ends in "_number", a number.
class FaultyPlugin final : public quadcore::Plugin {
 public:
  explicit FaultyPlugin(const quadcore::PluginSetup& setup)
      : fault_(setup.parameters.choice("fault")), after_(setup.parameters.number("after")) {
    throw_in("create", 0);
    if (fault_ == "tag") setup.parameters.number("speed");
  }

  std::size_t state_size() const override { return 1; }
  void update(const quadcore::Sample& sample, quadcore::PluginState state) const override {
    state[0] = sample.time;
    throw_in("update", sample.time);
  }
  void sense(const quadcore::Sample& sample, quadcore::PluginState) const override {
    throw_in("sense", sample.time);
  }
  void forces(const quadcore::Kinematics&, quadcore::ConstPluginState state,
              quadcore::Loads&) const override {
    throw_in("forces", state[0]);
  }

 private:
  void throw_in(const std::string& hook, double time) const {
    if (time < after_) return;
    if (fault_ == hook) throw std::runtime_error("out of\nluck");
    if (fault_ == hook + "_number") throw 13;
  }

  std::string fault_;
  double after_;  ///< s
};

quadcore::PluginDescriptor describe() {
#ifdef DESCRIBE_THROWS
  throw std::runtime_error("what am I?");
#endif
  return {
      "throws",
      {TagSpec::choice("fault",
                       {"none", "create", "create_number", "null", "tag", "update", "update_number",
                        "forces", "forces_number", "sense", "sense_number"},
                       "where"),
       TagSpec::number("after", "s", "0", "not before this time")},
      {},
      [](const quadcore::PluginSetup& setup) -> std::unique_ptr<quadcore::Plugin> {
        if (setup.parameters.choice("fault") == "null") return nullptr;
        return std::make_unique<FaultyPlugin>(setup);
      },
  };
}

}  // namespace

#ifdef OLDER_INTERFACE
extern "C" {
extern const int quadcore_plugin_abi;
const int quadcore_plugin_abi = quadcore::plugin_abi - 1;
const quadcore::PluginDescriptor* quadcore_plugin_descriptor() {
  static const quadcore::PluginDescriptor descriptor = describe();
  return &descriptor;
}
}
#else
QUADCORE_REGISTER_PLUGIN(describe)
#endif
