#include "quadcore/control/rotors.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <optional>

#include "arguments.hpp"
#include "bindings.hpp"
#include "guarded.hpp"

namespace quadcore::bindings {

using control::Rotor;

void bind_rotors(py::module_& m, py::class_<Guarded, std::shared_ptr<Guarded>>& simulation) {
  py::class_<Rotor>(m, "Rotor", R"(What a rotor exerts and how it follows a command.

Speeds are those of a command, rad/s, before the division by `slowdown`.)")
      .def("__repr__",
           [](const Rotor& r) {
             return py::str("<Rotor '{}', thrust_coefficient {:g}, torque_coefficient {:g}>")
                 .format(text(r.joint), r.thrust_coefficient, r.torque_coefficient);
           })
      .def_property_readonly(
          "joint", [](const Rotor& r) { return text(r.joint); }, "Name of the joint.")
      .def_property_readonly(
          "position", [](const Rotor& r) -> Vector3d { return r.p_FR_F; },
          "Origin of the rotor's link from that of the frame link, frame axes, m; shape (3,).")
      .def_property_readonly(
          "axis", [](const Rotor& r) -> Vector3d { return r.axis_F; },
          "Unit vector of the joint's axis, frame axes; shape (3,).")
      .def_readonly("spin", &Rotor::spin,
                    "Sense about `axis` in which the rotor turns in a hover: 1 by the right-hand "
                    "rule, -1 against it, 0 if unknown.")
      .def_readonly("thrust_coefficient", &Rotor::thrust_coefficient,
                    "Thrust along `axis` per squared speed, N s^2/rad^2.")
      .def_readonly("torque_coefficient", &Rotor::torque_coefficient,
                    "Size of the air's torque about `axis` per squared speed, N m s^2/rad^2.")
      .def_readonly("torque_sense", &Rotor::torque_sense,
                    "Sense of that torque on the frame: -1 against the spin, as in nature, 1 along "
                    "it, as the thesis has it (2.11), 0 without torque.")
      .def_readonly("max_speed", &Rotor::max_speed,
                    "Fastest commanded speed that the motor follows, rad/s; inf without a limit.")
      .def_readonly("slowdown", &Rotor::slowdown,
                    "Speed over the joint's velocity: 10 at a sim_slow of 10.")
      .def_readonly("rate_per_command", &Rotor::rate_per_command,
                    "Velocity of the joint in the long run per commanded speed; negative if a "
                    "positive command turns it backwards.")
      .def_readonly("time_constant", &Rotor::time_constant,
                    "Lag with which the rotor follows a command, s: the longer one where rising "
                    "and falling differ; nan if unknown.")
      .def_property_readonly(
          "command_index",
          [](const Rotor& r) {
            return r.place == not_driven ? std::nullopt : std::optional<int>(r.place);
          },
          "Index of its speed in a command; None if it follows none.");

  simulation.def_property_readonly(
      "rotors",
      [](const Self& self) {
        const Lock lock(*self);
        return py::tuple(py::cast(control::list_rotors(self->describe_vehicle())));
      },
      R"(Description of each rotor, in the order of `rotor_names`, tuple of Rotor.

Thrust and torque are measured on the force laws of all plugins, at rest in still air, as the tags
have them: losses during a flight are excluded. Each reading measures anew, which takes some
milliseconds.)");
}

}  // namespace quadcore::bindings
