#pragma once

#include <pybind11/numpy.h>

#include <string>
#include <type_traits>
#include <vector>

#include "built.hpp"
#include "older_pybind11.hpp"
#include "quadcore/plugin/error.hpp"

/// \file
/// Numbers and texts on their way between Python and the core.

namespace quadcore::bindings {

namespace py = pybind11;

/// Numbers as C++ reads them: row after row, each where a double may lie.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast |
                                        static_cast<int>(py::detail::npy_api::NPY_ARRAY_ALIGNED_)>;
/// A shape as Python writes it, "(2, 13)".
using Shape = std::vector<py::ssize_t>;

/// Real numbers from anything that numpy makes an array of so many dimensions of; `what` names it
/// in the InputError otherwise. No texts, no complex numbers, no masks.
Numbers numbers(const py::object& object, int dimensions, const char* what);

/// Throws InputError unless an array has this shape; `what` names it there. To be called for every
/// array whose size C++ does not take from the array itself.
void check_shape(const py::array& array, const Shape& shape, const char* what);

/// The array that C++ is to write to, as it lies in memory: no copy, which would take what is
/// written. Throws InputError unless it is a writable, contiguous array of doubles of this shape.
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

/// A whole number or a name that is refused in one line of quadcore's own if it is none; `what`
/// names it there.
template <class T, const char* what>
struct Given {
  using Python = std::conditional_t<std::is_integral_v<T>, py::int_, py::str>;
  static constexpr const char* kind =
      std::is_integral_v<T> ? "a whole number below 2^63" : "a name in UTF-8";
  T value;
};

/// Text by others, a plugin's say, as it can be shown.
py::str text(const std::string& text);
/// A file's name, which need not be UTF-8, as Python has it.
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
      std::string told = std::string(what) + ": give " + Given::kind;
      if (!isinstance<typename Given::Python>(source)) {
        told += quadcore::bindings::not_a(source);
      }
      throw quadcore::InputError(told);
    }
    value.value = cast_op<T&&>(std::move(caster));
    return true;
  }
};

}  // namespace pybind11::detail
