#pragma once

#include "guarded.hpp"
#include "quadcore/state.hpp"

/// \file
/// Conversion of a vehicle's state between Python and the core.

namespace quadcore::bindings {

/// Bind read-only arrays that view the simulation's state, and a function that copies the whole
/// state. They own the C++ simulation, not its Python object, so that no reference cycle keeps it
/// alive.
py::dict views(const Self& self);
/// Return the members of a state by name as separate arrays.
py::dict copies(const VehicleState& state);
/// Read a state from an object with the same members. Throws InputError if one is missing or has
/// another size.
VehicleState to_state(const py::object& object);

}  // namespace quadcore::bindings
