#pragma once

#include <memory>

#include "older_pybind11.hpp"

namespace quadcore::bindings {

namespace py = pybind11;

void bind_errors(py::module_& m);
void bind_document(py::module_& m);
void bind_model(py::module_& m);
void bind_world(py::module_& m);
void bind_clearance(py::module_& m);
void bind_plugins(py::module_& m);
void bind_snapshot(py::module_& m);
void bind_simulation(py::module_& m);
void bind_flight(py::module_& m);
void bind_fleet(py::module_& m);
void bind_batch(py::module_& m);
void bind_reference(py::module_& m);
void bind_odometry(py::module_& m);
void bind_control(py::module_& m);
void bind_control_loop(py::module_& m);
/// Turn crashes into errors: objects of bound classes without a completed constructor, and old
/// pickle protocols. Call this when all classes are bound.
void guard_classes(py::module_& m);

struct Guarded;
/// \name Add to the class of simulations
/// @{
void bind_rotors(py::module_& m, py::class_<Guarded, std::shared_ptr<Guarded>>& simulation);
void bind_topics(py::module_& m, py::class_<Guarded, std::shared_ptr<Guarded>>& simulation);
/// @}

}  // namespace quadcore::bindings
