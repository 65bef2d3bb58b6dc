#pragma once

#include <functional>
#include <memory>

#include "guarded.hpp"
#include "quadcore/flight.hpp"

namespace quadcore::bindings {

/// A flight and the simulation that it advances.
struct BoundFlight {
  std::shared_ptr<Guarded> guarded;
  Flight flight;
  py::ssize_t columns;                    ///< of its table
  std::function<void()> after_step = {};  ///< what a fleet calls after each step
};

}  // namespace quadcore::bindings
