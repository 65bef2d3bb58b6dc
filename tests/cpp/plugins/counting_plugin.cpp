#include "quadcore/plugin.hpp"

namespace {

using namespace quadcore;

/// Counts its updates.
class CountingPlugin final : public Plugin {
 public:
  explicit CountingPlugin(const PluginSetup&) {}

  std::size_t state_size() const override { return 1; }
  void update(const Sample&, PluginState state) const override { state[0] += 1; }
};

PluginDescriptor describe() { return {"counts", {}, {}, create<CountingPlugin>}; }

}  // namespace

QUADCORE_REGISTER_PLUGIN(describe)
