#pragma once

#include <array>

#include "older_pybind11.hpp"
#include "quadcore/plugin/messages.hpp"

namespace quadcore::bindings {

namespace py = pybind11;

/// A message of an odometry plugin. Its arrays are made when they are asked for, because a
/// controller that is called a thousand times a second reads only some of them.
struct BoundOdometry {
  py::object simulation;
  double stamp;  ///< of the message [s]
  messages::Odometry message;
  std::array<py::object, 4> arrays;
};

}  // namespace quadcore::bindings
