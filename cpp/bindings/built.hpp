#pragma once

#include <memory>
#include <string>

#include "older_pybind11.hpp"
#include "quadcore/plugin/error.hpp"

/// \file
/// Arguments of bound classes.

namespace quadcore::bindings {

/// Error message for an object without a call of __init__ or __setstate__.
constexpr char empty_object[] =
    "the object is empty because its constructor has not run. In a subclass, call "
    "super().__init__() first.";

/// The C++ object in a Python object of a bound class, never null.
template <class T>
struct Built {
  std::shared_ptr<T> held;

  const T& operator*() const { return *held; }
  const T* operator->() const { return held.get(); }
};

/// Return the end of an error about an object of the wrong type: ", not a 'str'".
inline std::string not_a(pybind11::handle object) {
  return std::string(", not a '") + Py_TYPE(object.ptr())->tp_name + "'";
}

/// Read the C++ object in a Python object. Throw InputError for another class or an empty object.
template <class T>
bool load_built(pybind11::handle source, bool convert, std::shared_ptr<T>& held) {
  if (!pybind11::isinstance<T>(source)) {
    const pybind11::handle wanted = pybind11::detail::get_type_handle(typeid(T), true);
    throw InputError("expected a " + pybind11::cast<std::string>(wanted.attr("__name__")) +
                     not_a(source) + ".");
  }
  auto* const instance = reinterpret_cast<pybind11::detail::instance*>(source.ptr());
  const pybind11::detail::type_info* const type = pybind11::detail::get_type_info(typeid(T));
  if (!instance->get_value_and_holder(type).holder_constructed()) throw InputError(empty_object);
  pybind11::detail::make_caster<std::shared_ptr<T>> caster;
  if (!caster.load(source, convert)) return false;
  held = pybind11::detail::cast_op<std::shared_ptr<T>&>(caster);
  return true;
}

}  // namespace quadcore::bindings

namespace pybind11::detail {

template <class T>
struct type_caster<quadcore::bindings::Built<T>> {
  PYBIND11_TYPE_CASTER(quadcore::bindings::Built<T>, make_caster<T>::name);

  bool load(handle source, bool convert) {
    return quadcore::bindings::load_built(source, convert, value.held);
  }
};

}  // namespace pybind11::detail
