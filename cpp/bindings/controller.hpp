#pragma once

#include "guarded.hpp"
#include "quadcore/control/guided_controller.hpp"

namespace quadcore::bindings {

/// A built-in controller and the simulation that it flies.
struct BoundController {
  Self flown;
  control::GuidedController controller;
};

}  // namespace quadcore::bindings
