#include "arguments.hpp"

#include <algorithm>
#include <cmath>

#include "quadcore/plugin/error.hpp"

namespace quadcore::bindings {
namespace {

struct AnyArray : py::array {
  /// Return an array of any type, or null with a Python exception.
  static PyObject* of(const py::object& object) { return raw_array(object.ptr()); }
};

bool is_masked(const py::object& object) {
  // Common types do not require a lookup of numpy.ma.
  const PyTypeObject* const type = Py_TYPE(object.ptr());
  if (type == &PyList_Type || type == py::detail::npy_api::get().PyArray_Type_) return false;
  return py::isinstance(object, py::module_::import("numpy.ma").attr("MaskedArray"));
}

/// Format a shape like Python, "(2, 13)".
std::string written(const Shape& shape) {
  std::string text;
  for (const py::ssize_t size : shape) text += (text.empty() ? "" : ", ") + std::to_string(size);
  return "(" + text + (shape.size() == 1 ? ",)" : ")");
}

Shape shape_of(const py::array& array) { return {array.shape(), array.shape() + array.ndim()}; }

}  // namespace

Numbers numbers(const py::object& object, int dimensions, const char* what) {
  const bool masked = is_masked(object);
  const auto array = py::reinterpret_steal<py::array>(masked ? nullptr : AnyArray::of(object));
  if (!array && !masked) {
    // Other exceptions, such as an interrupt, do not concern the argument.
    if (!PyErr_ExceptionMatches(PyExc_Exception)) throw py::error_already_set();
    PyErr_Clear();
  }
  const bool real = array && std::string("iuf").find(array.dtype().kind()) != std::string::npos;
  if (!real || array.ndim() != dimensions) {
    throw InputError(std::string(what) + " is not " +
                     (dimensions == 0
                          ? "a number"
                          : "a " + std::to_string(dimensions) + "-dimensional array of numbers") +
                     ". Give one.");
  }
  return Numbers(array);
}

void check_shape(const py::array& array, const Shape& shape, const char* what) {
  if (shape_of(array) == shape) return;
  throw InputError(std::string(what) + " has the shape " + written(shape_of(array)) +
                   ". Give an array of shape " + written(shape) + ".");
}

void check_finite(const double* numbers, std::size_t count, const char* what, const char* member) {
  if (std::all_of(numbers, numbers + count, [](double x) { return std::isfinite(x); })) return;
  throw InputError(std::string(what) + member + " is not finite. Give finite numbers.");
}

double* writable(const py::object& object, const Shape& shape, const char* what) {
  constexpr int as_read = py::array::c_style | py::detail::npy_api::NPY_ARRAY_ALIGNED_;
  if (py::isinstance<py::array_t<double>>(object)) {
    auto array = py::reinterpret_borrow<py::array_t<double>>(object);
    const bool fits = (array.flags() & as_read) == as_read && shape_of(array) == shape;
    if (fits && array.writeable()) return array.mutable_data();
  }
  throw InputError(std::string(what) + " is not a writable, contiguous float64 array of shape " +
                   written(shape) + ". Give such an array.");
}

py::str text(const std::string& text) { return one_line(text); }

py::str file_name(const std::string& path) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeFSDefaultAndSize(path.data(), static_cast<py::ssize_t>(path.size())));
}

}  // namespace quadcore::bindings
