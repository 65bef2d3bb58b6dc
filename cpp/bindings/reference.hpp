#pragma once

#include "older_pybind11.hpp"
#include "quadcore/plugin/messages.hpp"

/// \file
/// Conversion of references between Python and the core.

namespace quadcore::bindings {

/// Read a Reference from an object with the same members. Throws InputError if one is missing or
/// has another size.
messages::Reference to_reference(const pybind11::object& object);

}  // namespace quadcore::bindings
