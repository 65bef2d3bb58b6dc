#pragma once

#include <memory>

#include "guarded.hpp"
#include "quadcore/flight.hpp"

namespace quadcore::bindings {

/// A flight and the simulation that it advances.
struct BoundFlight {
  std::shared_ptr<Guarded> guarded;
  Flight flight;
  py::ssize_t columns;  ///< of its table
};

}  // namespace quadcore::bindings
