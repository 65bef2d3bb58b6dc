#pragma once

#include <memory>
#include <string>

#include "older_pybind11.hpp"
#include "quadcore/error.hpp"

/// \file
/// Guards against Python objects whose __init__ or __setstate__ was not called: pybind11 would give
/// memory that nothing was built in.

namespace quadcore::bindings {

/// What a Python object of a bound class holds, never null.
template <class T>
struct Built {
  std::shared_ptr<T> held;

  const T& operator*() const { return *held; }
  const T* operator->() const { return held.get(); }
};

/// Of what type an object is that should be of another, behind "give a Model".
inline std::string not_a(pybind11::handle object) {
  return std::string(", not a '") + Py_TYPE(object.ptr())->tp_name + "'";
}

/// Reads what an object holds. Throws InputError for another class, or if it holds nothing.
template <class T>
bool load_built(pybind11::handle source, bool convert, std::shared_ptr<T>& held,
                const char* if_empty) {
  if (!pybind11::isinstance<T>(source)) {
    const pybind11::handle wanted = pybind11::detail::get_type_handle(typeid(T), true);
    throw InputError("give a " + pybind11::cast<std::string>(wanted.attr("__name__")) +
                     not_a(source));
  }
  auto* const instance = reinterpret_cast<pybind11::detail::instance*>(source.ptr());
  if (!instance->get_value_and_holder().holder_constructed()) throw InputError(if_empty);
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
    return quadcore::bindings::load_built(source, convert, value.held,
                                          "nothing was read into this object; use read_model, "
                                          "read_world or a simulation's snapshot()");
  }
};

}  // namespace pybind11::detail
