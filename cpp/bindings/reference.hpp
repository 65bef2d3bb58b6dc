#pragma once

#include "older_pybind11.hpp"
#include "quadcore/plugin/messages.hpp"

/// \file
/// References on their way between Python and the core.

namespace quadcore::bindings {

/// Reads the members of an object that has those of a Reference. Throws InputError if one is
/// missing or of another size.
messages::Reference to_reference(const pybind11::object& object);

}  // namespace quadcore::bindings
