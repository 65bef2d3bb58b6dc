#pragma once

#include "guarded.hpp"
#include "quadcore/state.hpp"

/// \file
/// A vehicle's state on its way between Python and the core.

namespace quadcore::bindings {

/// Read-only arrays onto the simulation's own state, and a function that copies all of it at one
/// moment. They own a share of the simulation, not of its Python object, so that no reference cycle
/// keeps it alive.
py::dict views(const Self& self);
/// The members of a state by name, as arrays of their own.
py::dict copies(const VehicleState& state);
/// Reads the members of an object that has those of a state. Throws InputError if one is missing or
/// of another size.
VehicleState to_state(const py::object& object);

}  // namespace quadcore::bindings
