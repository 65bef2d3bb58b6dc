#include "quadcore/control/rotors.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <limits>
#include <optional>

#include "arguments.hpp"
#include "bindings.hpp"
#include "guarded.hpp"

namespace quadcore::bindings {

using control::Rotor;

void bind_rotors(py::module_& m, py::class_<Guarded, std::shared_ptr<Guarded>>& simulation) {
  py::class_<Rotor>(m, "Rotor", R"(Thrust, torque and dynamics of a rotor.

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
          "Origin of the rotor's link relative to the frame link's, frame axes, m; shape (3,).")
      .def_property_readonly(
          "axis", [](const Rotor& r) -> Vector3d { return r.axis_F; },
          "Unit vector of the joint's axis, frame axes; shape (3,).")
      .def_readonly("spin", &Rotor::spin,
                    "Direction of rotation about `axis` in hover: 1 by the right-hand rule, -1 "
                    "opposite, 0 if unknown.")
      .def_readonly("thrust_coefficient", &Rotor::thrust_coefficient,
                    "Thrust along `axis` per squared speed, N s^2/rad^2.")
      .def_readonly(
          "torque_coefficient", &Rotor::torque_coefficient,
          "Magnitude of the aerodynamic torque about `axis` per squared speed, N m s^2/rad^2.")
      .def_readonly("torque_sense", &Rotor::torque_sense,
                    "Direction of that torque on the frame: -1 opposing the spin (physical), 1 "
                    "along it (thesis (2.11)), 0 without torque.")
      .def_readonly("max_speed", &Rotor::max_speed,
                    "Maximum speed that the motor follows, rad/s; inf without a limit.")
      .def_readonly("slowdown", &Rotor::slowdown,
                    "Rotor speed divided by the joint's velocity: 10 for a sim_slow of 10.")
      .def_readonly("rate_per_command", &Rotor::rate_per_command,
                    "Steady-state joint velocity per commanded speed; negative if a positive "
                    "command turns it backwards.")
      .def_readonly("time_constant", &Rotor::time_constant,
                    "Time constant with which the rotor follows a command, s: the longer one if "
                    "rising and falling differ; nan if unknown.")
      .def_property_readonly(
          "command_index",
          [](const Rotor& r) {
            return r.place == not_driven ? std::nullopt : std::optional<int>(r.place);
          },
          "Index of the rotor's speed in a command; None if it follows no command.");

  simulation.def_property_readonly(
      "_command_limits",
      [](const Self& self) {
        VectorXd limits = VectorXd::Constant(static_cast<Eigen::Index>(self->command_width()),
                                             std::numeric_limits<double>::infinity());
        for (const RotorDescription& rotor : self->drives()) {
          if (rotor.place == not_driven) continue;
          if (rotor.place < 0 || rotor.place >= limits.size()) {
            throw InputError("a motor plugin sets place " + std::to_string(rotor.place) +
                             " in describe_rotors(), but a command has " +
                             std::to_string(limits.size()) +
                             " rotor speeds. Begin with 0, and give each rotor its own place.");
          }
          limits[rotor.place] = rotor.fastest;
        }
        return limits;
      },
      "Maximum speed of each command that its motor follows, rad/s; shape (n,).");
  simulation.def_property_readonly(
      "_rates_per_command",
      [](const Self& self) {
        VectorXd rates(static_cast<Eigen::Index>(self->drives().size()));
        for (Eigen::Index i = 0; i < rates.size(); ++i) {
          rates[i] = self->drives()[static_cast<std::size_t>(i)].rate_per_command;
        }
        return rates;
      },
      "Steady-state joint velocity per commanded speed; shape (rotors,).");
  simulation.def_property_readonly(
      "rotors",
      [](const Self& self) {
        const Lock lock(*self);
        return py::tuple(py::cast(control::list_rotors(self->describe_vehicle())));
      },
      R"(Description of each rotor, in the order of `rotor_names`, tuple of Rotor.

Thrust and torque are measured on the force laws of all plugins, at rest in still air, as the tags
have them: losses during a flight are excluded. The first access, and that after a change of the
attached bodies, takes some milliseconds.)");
}

}  // namespace quadcore::bindings
