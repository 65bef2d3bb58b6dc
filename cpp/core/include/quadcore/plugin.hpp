#pragma once

/// \file
/// Includes all headers for plugins, those of quadcore/plugin.

#include "quadcore/plugin/carried_body.hpp"
#include "quadcore/plugin/counts.hpp"
#include "quadcore/plugin/document.hpp"
#include "quadcore/plugin/effect.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/hooks.hpp"
#include "quadcore/plugin/ignored_elements.hpp"
#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/plugin/loads.hpp"
#include "quadcore/plugin/messages.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/other_vehicle.hpp"
#include "quadcore/plugin/random.hpp"
#include "quadcore/plugin/rotor_layout.hpp"
#include "quadcore/plugin/rotor_rows.hpp"
#include "quadcore/plugin/spatial.hpp"
#include "quadcore/plugin/switch.hpp"
#include "quadcore/plugin/tags.hpp"
#include "quadcore/plugin/topics.hpp"
#include "quadcore/plugin/vehicle_description.hpp"
#include "quadcore/plugin/world.hpp"
