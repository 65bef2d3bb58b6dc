#pragma once

#include "older_pybind11.hpp"

namespace quadcore::bindings {

namespace py = pybind11;

void bind_errors(py::module_& m);
void bind_model(py::module_& m);
void bind_plugins(py::module_& m);
void bind_snapshot(py::module_& m);
void bind_simulation(py::module_& m);
void bind_flight(py::module_& m);

}  // namespace quadcore::bindings
