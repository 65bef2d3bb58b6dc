#include "reference.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <initializer_list>
#include <string>

#include "arguments.hpp"
#include "bindings.hpp"
#include "guarded.hpp"
#include "quadcore/control/controller.hpp"
#include "quadcore/control/rows_file.hpp"

namespace quadcore::bindings {

using control::Reference;
using control::ReferenceShape;
using control::Values;

namespace {

/// Read the members that get(name) returns.
template <class Get>
Reference read_members(const Get& get) {
  Reference read;
  Reference::for_each_field(
      read, [&get](const char* name, std::initializer_list<const char*> fields, double* data) {
        const std::string what = std::string("reference.") + name;
        const Numbers array = numbers(get(name), fields.size() == 1 ? 0 : 1, what.c_str());
        if (array.size() != static_cast<py::ssize_t>(fields.size())) {
          throw InputError(what + " has " + std::to_string(array.size()) + " numbers. Give " +
                           std::to_string(fields.size()) + ".");
        }
        std::copy_n(array.data(), fields.size(), data);
      });
  return read;
}

Reference reference_of(const ArrayLike& position, const ArrayLike& velocity,
                       const ArrayLike& acceleration, const ArrayLike& jerk, const ArrayLike& snap,
                       const ArrayLike& yaw, const ArrayLike& yaw_rate,
                       const ArrayLike& yaw_acceleration) {
  const py::object* member[] = {&position, &velocity, &acceleration, &jerk,
                                &snap,     &yaw,      &yaw_rate,     &yaw_acceleration};
  const py::object** next = member;
  return read_members([&next](const char*) { return **next++; });
}

/// Return position and yaw at each of these times, shape (n, 4).
control::Rows places(const ReferenceShape& shape, const py::object& given) {
  const Numbers times = numbers(given, 1, "times");
  control::Rows rows(times.shape(0), 4);
  for (py::ssize_t i = 0; i < times.shape(0); ++i) {
    const Reference wanted = shape.at(times.data()[i]);
    rows.row(i) << wanted.position.transpose(), wanted.yaw;
  }
  return rows;
}

/// Return the numbers of the reference at each of these times, shape (n, 18), as in a message.
control::Rows sample(const ReferenceShape& shape, const py::object& given) {
  const Numbers times = numbers(given, 1, "times");
  const auto width = messages::kind_of<Reference>().fields.size();
  control::Rows rows(times.shape(0), static_cast<Eigen::Index>(width));
  for (py::ssize_t i = 0; i < times.shape(0); ++i) {
    messages::write(shape.at(times.data()[i]), rows.row(i).data());
  }
  return rows;
}

control::Rows rows_of(const py::object& rows) {
  if (rows.is_none()) return {};
  const Numbers table = numbers(rows, 2, "rows");
  return Eigen::Map<const control::Rows>(table.data(), table.shape(0), table.shape(1));
}

Reference read_reference(const py::object& object) {
  if (py::isinstance<Reference>(object)) return object.cast<Reference>();
  return read_members([&object](const char* name) -> py::object {
    try {
      return object.attr(name);
    } catch (const py::error_already_set& error) {
      if (!error.matches(PyExc_AttributeError)) throw;
      throw InputError(std::string("the reference has no member ") + name +
                       ". Give a quadcore.Reference or an object with the same members.");
    }
  });
}

}  // namespace

messages::Reference to_reference(const py::object& object) {
  Reference reference = read_reference(object);
  Reference::for_each_field(
      reference, [](const char* name, std::initializer_list<const char*> fields,
                    const double* data) { check_finite(data, fields.size(), "reference.", name); });
  return reference;
}

void bind_reference(py::module_& m) {
  const Vector3d zero = Vector3d::Zero();
  py::class_<Reference>(m, "Reference",
                        R"(Desired position and yaw with their derivatives, world axes.

The reference that a controller receives also has `at(t)`, the reference at other times.)",
                        py::dynamic_attr())
      .def("__repr__",
           [](const Reference& r) {
             return py::str("Reference(position={}, velocity={}, acceleration={}, yaw={:.6g}, ...)")
                 .format(r.position, r.velocity, r.acceleration, r.yaw);
           })
      .def(py::init(&reference_of), py::arg("position") = zero, py::arg("velocity") = zero,
           py::arg("acceleration") = zero, py::arg("jerk") = zero, py::arg("snap") = zero,
           py::arg("yaw") = 0, py::arg("yaw_rate") = 0, py::arg("yaw_acceleration") = 0)
      .def_readwrite("position", &Reference::position,
                     "Position of the frame's origin, m; shape (3,).")
      .def_readwrite("velocity", &Reference::velocity, "Velocity, m/s; shape (3,).")
      .def_readwrite("acceleration", &Reference::acceleration, "Acceleration, m/s^2; shape (3,).")
      .def_readwrite("jerk", &Reference::jerk, "Jerk, m/s^3; shape (3,).")
      .def_readwrite("snap", &Reference::snap, "Snap, m/s^4; shape (3,).")
      .def_readwrite("yaw", &Reference::yaw, "rad.")
      .def_readwrite("yaw_rate", &Reference::yaw_rate, "rad/s.")
      .def_readwrite("yaw_acceleration", &Reference::yaw_acceleration, "rad/s^2.");

  py::class_<ReferenceShape>(m, "ReferenceShape", "Reference as a function of time.")
      .def(py::init([](const std::string& name, const Values& values, const py::object& rows) {
             return control::make_reference(name, values, rows_of(rows));
           }),
           py::arg("name"), py::arg("values"), py::arg("rows") = py::none())
      .def("at", &ReferenceShape::at, py::arg("t"), "Return the reference at a time [s].")
      .def("sample", &sample, py::arg("times"),
           "Return position, velocity, acceleration, jerk, snap, yaw, yaw rate and yaw "
           "acceleration at several times [s]; shape (n, 18).")
      .def("places", &places, py::arg("times"),
           "Return position [m] and yaw [rad] at several times [s]; shape (n, 4).")
      .def_property_readonly(
          "end", &ReferenceShape::end,
          "Time from which the reference is at rest, s; infinite if it never is.");

  m.def(
      "on_vehicle",
      [](const std::string& name, const Values& values, const Self& simulation) {
        const Lock lock(*simulation);
        return control::on_vehicle(name, values, simulation->model());
      },
      py::arg("name"), py::arg("values"), py::arg("simulation"),
      "Complete the parameters of a reference with values of a vehicle.");
  m.def("read_rows", &control::read_rows, py::arg("path"),
        "Read the rows of a .csv or .yaml file.");
  m.def(
      "references",
      [] {
        py::list all;
        for (const control::ReferenceInfo& info : control::references()) {
          all.append(py::make_tuple(info.name, info.summary, info.table, info.takes_rows));
        }
        return all;
      },
      "Return name, summary and parameters of every reference, and whether it requires rows.");
}

}  // namespace quadcore::bindings
