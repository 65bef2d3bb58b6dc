#include "quadcore/plugin.hpp"

/// A plugin built against a core that does not exist yet.
extern "C" {
extern const int quadcore_plugin_abi;
const int quadcore_plugin_abi = quadcore::plugin_abi + 1;
const quadcore::PluginDescriptor* quadcore_plugin_descriptor() { return nullptr; }
}
