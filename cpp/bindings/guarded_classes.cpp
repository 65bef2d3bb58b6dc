#include <pybind11/pybind11.h>

#include "bindings.hpp"
#include "built.hpp"

namespace quadcore::bindings {
namespace {

/// pybind11 calls this for the C++ part of an object without a completed constructor. Otherwise it
/// would use uninitialised memory.
void* refuse_empty(std::size_t) { throw InputError(empty_object); }

/// Pickling with protocols 0 and 1 would call a constructor of pybind11 that ends the process.
py::object reduced(const py::object& self) {
  if (!py::hasattr(self, "__setstate__")) {
    throw py::type_error(std::string("cannot pickle '") + Py_TYPE(self.ptr())->tp_name +
                         "' object");
  }
  return py::make_tuple(py::module_::import("copyreg").attr("__newobj__"),
                        py::make_tuple(self.attr("__class__")), self.attr("__getstate__")());
}

}  // namespace

void guard_classes(py::module_& m) {
  for (const auto& [name, held] : py::dict(m.attr("__dict__"))) {
    if (!PyType_Check(held.ptr())) continue;
    auto* const type = reinterpret_cast<PyTypeObject*>(held.ptr());
    py::detail::type_info* const bound = py::detail::get_type_info(type);
    if (!bound) continue;  // it is an exception
    bound->operator_new = &refuse_empty;
    held.attr("__reduce__") =
        py::cpp_function(&reduced, py::name("__reduce__"), py::is_method(held));
  }
}

}  // namespace quadcore::bindings
