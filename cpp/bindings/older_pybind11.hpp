#pragma once

#include <pybind11/pybind11.h>

/// \file
/// Names that are missing in the pybind11 package of Ubuntu 20.04.

#if PYBIND11_VERSION_MAJOR == 2 && PYBIND11_VERSION_MINOR < 6
namespace pybind11 {
using module_ = module;
}
#endif

#if PYBIND11_VERSION_MAJOR == 2 && PYBIND11_VERSION_MINOR < 8
namespace pybind11::detail {
template <size_t n>
constexpr auto const_name(const char (&text)[n]) {
  return _(text);
}
}  // namespace pybind11::detail
#endif
