#include "quadcore/plugin.hpp"

/// A plugin built against a core that does not exist yet.
extern "C" {
QUADCORE_PLUGIN_EXPORT extern const quadcore::PluginModule QUADCORE_PLUGIN_SYMBOL;
const quadcore::PluginModule QUADCORE_PLUGIN_SYMBOL = {"of tomorrow", nullptr};
}
