#pragma once

#include <pybind11/numpy.h>

#include <string>

#include "older_pybind11.hpp"

/// \file
/// Numbers and texts on their way between Python and the core.

namespace quadcore::bindings {

namespace py = pybind11;

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Real numbers from anything that numpy makes an array of so many dimensions of; `what` names it
/// in the InputError otherwise. No texts, no complex numbers, no masks.
Numbers numbers(const py::object& object, int dimensions, const char* what);

/// Text by others, a plugin's say, as it can be shown.
py::str text(const std::string& text);
/// A file's name, which need not be UTF-8, as Python has it.
py::str file_name(const std::string& path);

}  // namespace quadcore::bindings
