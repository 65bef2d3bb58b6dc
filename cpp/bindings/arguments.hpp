#pragma once

#include <pybind11/numpy.h>

#include <string>
#include <type_traits>
#include <vector>

#include "built.hpp"
#include "older_pybind11.hpp"
#include "quadcore/plugin/error.hpp"

/// \file
/// Conversion of numbers and texts between Python and the core.

namespace quadcore::bindings {

namespace py = pybind11;

/// Numbers for C++: a contiguous, aligned array of doubles in row-major order.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast |
                                        static_cast<int>(py::detail::npy_api::NPY_ARRAY_ALIGNED_)>;
/// Numbers of elements along the dimensions of an array.
using Shape = std::vector<py::ssize_t>;

/// Return real numbers from any object that numpy converts to an array of so many dimensions.
/// Throws InputError with the name `what` otherwise, and for texts, complex numbers and masked
/// arrays.
Numbers numbers(const py::object& object, int dimensions, const char* what);

/// Throw InputError with the name `what` unless an array has this shape. Call this for every array
/// of a size that C++ assumes.
void check_shape(const py::array& array, const Shape& shape, const char* what);

/// Throw InputError with the names `what` and `member`, joined, unless all numbers are finite.
void check_finite(const double* numbers, std::size_t count, const char* what,
                  const char* member = "");

/// Return the array that C++ writes to, without a copy. Throws InputError unless it is a writable,
/// contiguous array of doubles of this shape.
double* writable(const py::object& object, const Shape& shape, const char* what);

/// Any object; signatures in docstrings name it by `type`.
template <const auto& type>
class Annotated : public py::object {
 public:
  PYBIND11_OBJECT_DEFAULT(Annotated, py::object, is_any)

 private:
  static bool is_any(PyObject*) { return true; }
};

inline constexpr char array_like[] = "numpy.typing.ArrayLike";
inline constexpr char state_type[] = "quadcore.State";
using ArrayLike = Annotated<array_like>;
using StateLike = Annotated<state_type>;

/// A whole number or a name. Another object is an InputError with the name `what`.
template <class T, const char* what>
struct Given {
  using Python = std::conditional_t<std::is_integral_v<T>, py::int_, py::str>;
  static constexpr const char* kind =
      std::is_integral_v<T> ? "a whole number below 2^63" : "a name in UTF-8";
  T value;
};

/// Return a foreign text, such as that of a plugin, for display.
py::str text(const std::string& text);
/// Return a file name, which need not be UTF-8, as a Python string.
py::str file_name(const std::string& path);

}  // namespace quadcore::bindings

namespace pybind11::detail {

template <const auto& type>
struct handle_type_name<quadcore::bindings::Annotated<type>> {
  static constexpr auto name = const_name(type);
};

template <class T, const char* what>
struct type_caster<quadcore::bindings::Given<T, what>> {
  using Given = quadcore::bindings::Given<T, what>;
  PYBIND11_TYPE_CASTER(Given, make_caster<T>::name);

  bool load(handle source, bool convert) {
    make_caster<T> caster;
    if (!caster.load(source, convert)) {
      std::string message = std::string(what) + " must be " + Given::kind;
      if (!isinstance<typename Given::Python>(source)) {
        message += quadcore::bindings::not_a(source);
      }
      throw quadcore::InputError(message + ".");
    }
    value.value = cast_op<T&&>(std::move(caster));
    return true;
  }
};

}  // namespace pybind11::detail
