#include "odometry.hpp"

#include <pybind11/numpy.h>

#include <memory>
#include <string>

#include "bindings.hpp"
#include "guarded.hpp"
#include "quadcore/control/guided_controller.hpp"

namespace quadcore::bindings {
namespace {

std::unique_ptr<BoundOdometry> create_odometry(const py::object& simulation,
                                               const std::string& topic) {
  const auto self = simulation.cast<Self>();
  const Lock lock(*self);
  const Topics& topics = self->topics();
  const std::size_t index = control::GuidedController::find_odometry(topics, topic);
  return std::make_unique<BoundOdometry>(
      BoundOdometry{simulation, topics[index].stamp, topics.read<messages::Odometry>(index), {}});
}

/// A getter of a member as a read-only array, which is made once.
template <std::size_t place, class Read>
auto array_of(const Read& read) {
  return [read](BoundOdometry& odometry) {
    py::object& array = odometry.arrays[place];
    if (!array) {
      const auto& numbers = read(odometry.message);
      array = py::array_t<double>(numbers.size(), numbers.data());
      py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    }
    return array;
  };
}

}  // namespace

void bind_odometry(py::module_& m) {
  using messages::Odometry;
  py::class_<BoundOdometry>(
      m, "Odometry",
      R"(Latest message of the odometry plugin, including the noise that its tags define.

Parameters
----------
simulation : Simulation
    Simulation to read the odometry of.
topic : str
    Topic of the odometry.)")
      .def(py::init(&create_odometry), py::arg("simulation"), py::arg("topic") = "odom")
      .def_readonly("time", &BoundOdometry::stamp, "Time of the measurement, s.")
      .def_property_readonly("position",
                             array_of<0>([](const Odometry& o) -> auto& { return o.position; }),
                             "Position of the frame's origin in the world, m; shape (3,).")
      .def_property_readonly(
          "orientation",
          array_of<1>([](const Odometry& o) -> auto& { return o.orientation.coeffs(); }),
          "Orientation of the frame in the world, unit quaternion x, y, z, w; shape (4,).")
      .def_property_readonly(
          "linear_velocity",
          array_of<2>([](const Odometry& o) -> auto& { return o.linear_velocity; }),
          "Velocity of the frame's origin in the axes that the plugin's `twistFrame` names, m/s; "
          "shape (3,).")
      .def_property_readonly("angular_velocity", array_of<3>([](const Odometry& o) -> auto& {
                               return o.angular_velocity;
                             }),
                             "Angular velocity of the frame in body axes, rad/s; shape (3,).")
      .def_property_readonly(
          "topic", [](const BoundOdometry& o) { return o.simulation.attr("topic"); },
          "Function that returns the message of another topic by its name, as "
          "`Simulation.topic` does.");
}

}  // namespace quadcore::bindings
