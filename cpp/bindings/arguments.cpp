#include "arguments.hpp"

#include "quadcore/error.hpp"

namespace quadcore::bindings {
namespace {

struct AnyArray : py::array {
  /// An array of whatever type, or null and Python's exception.
  static PyObject* of(const py::object& object) { return raw_array(object.ptr()); }
};

bool is_masked(const py::object& object) {
  // The usual ones need not look for numpy.ma.
  const PyTypeObject* const type = Py_TYPE(object.ptr());
  if (type == &PyList_Type || type == py::detail::npy_api::get().PyArray_Type_) return false;
  return py::isinstance(object, py::module_::import("numpy.ma").attr("MaskedArray"));
}

}  // namespace

Numbers numbers(const py::object& object, int dimensions, const char* what) {
  const bool masked = is_masked(object);
  const auto array = py::reinterpret_steal<py::array>(masked ? nullptr : AnyArray::of(object));
  if (!array && !masked) {
    // What is no such error, an interrupt, is not about the argument.
    if (!PyErr_ExceptionMatches(PyExc_Exception)) throw py::error_already_set();
    PyErr_Clear();
  }
  const bool real = array && std::string("iuf").find(array.dtype().kind()) != std::string::npos;
  if (!real || array.ndim() != dimensions) {
    throw InputError(std::string(what) + " is not " +
                     (dimensions == 0
                          ? "a number"
                          : "a " + std::to_string(dimensions) + "-dimensional array of numbers"));
  }
  return Numbers(array);
}

py::str text(const std::string& text) { return one_line(text); }

py::str file_name(const std::string& path) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeFSDefaultAndSize(path.data(), static_cast<py::ssize_t>(path.size())));
}

}  // namespace quadcore::bindings
