#include <exception>

#include "bindings.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::bindings {
namespace {

// Python's types live as long as the interpreter; these references are never released.
PyObject* error_type;
PyObject* input_error_type;
PyObject* flight_error_type;

PyObject* new_type(py::module_& m, const char* name, PyObject* base, const char* doc) {
  const std::string full_name = std::string("quadcore.") + name;
  PyObject* type = PyErr_NewExceptionWithDoc(full_name.c_str(), doc, base, nullptr);
  if (!type) throw py::error_already_set();
  m.attr(name) = py::handle(type);
  return type;
}

/// Return an error message as one line, even if Python code has created it.
py::str shown(const py::object& error) {
  const py::str text = py::handle(PyExc_RuntimeError).attr("__str__")(error);
  const py::bytes bytes = text.attr("encode")("utf-8", "replace");
  return one_line(std::string(bytes));
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const FlightError& error) {
    py::object instance = py::reinterpret_borrow<py::object>(flight_error_type)(error.what());
    instance.attr("time") = error.time();
    PyErr_SetObject(flight_error_type, instance.ptr());
  } catch (const InputError& error) {
    PyErr_SetString(input_error_type, error.what());
  } catch (const Error& error) {
    PyErr_SetString(error_type, error.what());
  }
}

}  // namespace

void bind_errors(py::module_& m) {
  error_type = new_type(m, "QuadcoreError", PyExc_RuntimeError,
                        "Base class of all quadcore errors. str() is one line and gives "
                        "``FILE:LINE`` for invalid input.");
  m.attr("QuadcoreError").attr("__str__") =
      py::cpp_function(&shown, py::name("__str__"), py::is_method(m.attr("QuadcoreError")));
  input_error_type =
      new_type(m, "InputError", error_type, "Invalid input. The rejected call changed nothing.");
  flight_error_type =
      new_type(m, "FlightError", error_type,
               "Failure of the flight. Attribute `time` is the time of the failure in s.");
  py::register_exception_translator(&translate);
}

}  // namespace quadcore::bindings
