#include "quadcore/plugin.hpp"

/// A plugin built against a core that does not exist yet.
extern "C" {
QUADCORE_EXPORT extern const quadcore::PluginModule quadcore_plugin;
const quadcore::PluginModule quadcore_plugin = {"of tomorrow", nullptr};
}
