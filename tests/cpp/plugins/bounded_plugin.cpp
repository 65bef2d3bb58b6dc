#include "quadcore/force_laws.hpp"
#include "quadcore/law_interface.hpp"
#include "quadcore/plugin.hpp"

namespace {

using namespace quadcore;

/// States bounds of an update() that it does not have.
class BoundedPlugin final : public Plugin {
 public:
  static constexpr const char* law_interface = quadcore::law_interface;

  explicit BoundedPlugin(const PluginSetup&) {}

  void laws(ConstPluginState, ForceLaws& laws) const override { laws.quiet.push_back({}); }
};

PluginDescriptor describe() { return {"states bounds", {}, {}, create<BoundedPlugin>}; }

}  // namespace

QUADCORE_REGISTER_PLUGIN(describe)
