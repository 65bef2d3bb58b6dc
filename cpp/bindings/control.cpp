#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "arguments.hpp"
#include "bindings.hpp"
#include "guarded.hpp"
#include "quadcore/control/controller.hpp"
#include "quadcore/control/gains_file.hpp"
#include "quadcore/control/inner_loop.hpp"
#include "quadcore/control/rotor_health.hpp"
#include "quadcore/control/second_vehicle.hpp"
#include "quadcore/control/start.hpp"
#include "quadcore/rotor_shares.hpp"
#include "reference.hpp"

namespace quadcore::bindings {
namespace {

using control::Controller;
using control::ReferenceShape;
using control::Values;

/// What commands rotors, and its memory.
template <class Controller>
struct Flown {
  Controller controller;
  std::vector<double> state;

  template <class Wanted>
  py::array_t<double> command(double period, const messages::Odometry& now, const Wanted& wanted) {
    py::array_t<double> speeds(static_cast<py::ssize_t>(controller.rotors()));
    controller.command(period, now, wanted, state.data(), speeds.mutable_data());
    return speeds;
  }
};
using FlownInnerLoop = Flown<control::InnerLoop>;

/// A controller that reads the health of the rotors if a plugin publishes it.
struct FlownLaw : Flown<Controller> {
  Self flown;
  control::RotorHealth health;
  int topic;  ///< of the health; -1: none

  /// Call it with the vehicle locked.
  void hear() {
    if (topic < 0) return;
    const Topic& said = flown->topics()[static_cast<std::size_t>(topic)];
    health.tell(said, flown->time(), controller, state.data());
  }
};

VehicleDescription describe(const Self& self) {
  const Lock lock(*self);
  return self->describe_vehicle();
}

void refuse_velocity_in_body(const std::string& who, const Self& flown) {
  if (!flown->has_velocity_in_body()) return;
  throw InputError(who + " needs velocities in the world; set <twistFrame> to world");
}

/// A vehicle, driven as the one that flies, which it may be itself.
VehicleDescription describe_as(const Self& believed, const Self& flown) {
  if (&*believed == &*flown) return describe(flown);
  return control::driven_as(describe(flown), describe(believed), "the belief ");
}

Vector3d vector(const py::object& object, const char* what) {
  const Numbers array = numbers(object, 1, what);
  if (array.size() != 3) throw InputError(std::string(what) + " has not three numbers");
  return Eigen::Map<const Vector3d>(array.data());
}

Quaterniond orientation(const py::object& object, const char* what) {
  const Numbers array = numbers(object, 1, what);
  if (array.size() != 4) throw InputError(std::string(what) + " has not four numbers");
  return Quaterniond(Eigen::Map<const Eigen::Vector4d>(array.data()));
}

messages::Odometry odometry(const py::object& state) {
  messages::Odometry now;
  now.position = vector(state.attr("position"), "state.position");
  now.orientation = orientation(state.attr("orientation"), "state.orientation");
  now.linear_velocity = vector(state.attr("linear_velocity"), "state.linear_velocity");
  now.angular_velocity = vector(state.attr("angular_velocity"), "state.angular_velocity");
  return now;
}

/// The same from what stands on a topic and from a shape, with no Python object between.
py::array_t<double> command_at(FlownLaw& flown, double period, const Self& self,
                               const std::string& sensed, const ReferenceShape& shape) {
  const Lock lock(*self);
  static const MessageKind odometry = messages::kind_of<messages::Odometry>();
  const Topics& topics = self->topics();
  const std::size_t topic = topics.at(sensed);
  const MessageKind& kind = topics[topic].kind;
  if (kind.name != odometry.name || kind.fields.size() != odometry.fields.size()) {
    throw InputError("topic '" + sensed + "' holds no odometry. Name one that does.");
  }
  const auto now = topics.read<messages::Odometry>(topic);
  flown.hear();
  return flown.command(period, now, shape.at(self->time()));
}

py::dict start(const Self& self, const py::object& wanted, const std::vector<double>& spins) {
  const VehicleState state = control::start_on(to_reference(wanted), describe(self), spins);
  py::dict members;
  members["position"] = state.position;
  members["orientation"] = Eigen::Vector4d(state.orientation.coeffs());
  members["linear_velocity"] = state.linear_velocity;
  members["angular_velocity"] = state.angular_velocity;
  members["rotor_velocity"] = state.rotor_velocity;
  members["rotor_angle"] = state.rotor_angle;
  return members;
}

}  // namespace

void bind_control(py::module_& m) {
  py::class_<TagSpec>(m, "ParameterSpec", "A parameter of a law or a reference.")
      .def_readonly("name", &TagSpec::name, "Of the parameter.")
      .def_readonly("unit", &TagSpec::unit, "\"\" without one.")
      .def_readonly("default", &TagSpec::fallback, "As text.")
      .def_readonly("meaning", &TagSpec::meaning, "In one line.")
      .def_readonly("equation", &TagSpec::equation,
                    "Where it stands in the source; \"\" if nowhere.")
      .def_property_readonly(
          "is_flag", [](const TagSpec& spec) { return spec.kind == TagKind::flag; },
          "Whether it is true or false.")
      .def_property_readonly(
          "range", [](const TagSpec& spec) { return spec.range(); },
          "Values that it may have, for a person.");

  py::class_<FlownLaw>(m, "Controller", "A law that flies one vehicle.")
      .def(
          py::init([](const std::string& law, const Self& believed, const Self& flown,
                      const Values& values, const std::vector<double>& spins) {
            refuse_velocity_in_body("law '" + law + "'", flown);
            Controller made(law, describe_as(believed, flown), values, spins);
            const std::size_t size = Controller::state_size(law, made.rotors());
            return std::make_unique<FlownLaw>(FlownLaw{{std::move(made), std::vector<double>(size)},
                                                       flown,
                                                       control::RotorHealth(describe(flown)),
                                                       flown->topics().find(health_topic)});
          }),
          py::arg("law"), py::arg("believed"), py::arg("flown"), py::arg("values"),
          py::arg("spins"))
      .def(
          "command",
          [](FlownLaw& flown, double period, const py::object& state, const py::object& wanted) {
            {
              const Lock lock(*flown.flown);
              flown.hear();
            }
            return flown.command(period, odometry(state), to_reference(wanted));
          },
          py::arg("period"), py::arg("state"), py::arg("reference"),
          "Rotor speeds to command for a period [s], signed, rad/s; shape (n,). The state is what "
          "an odometry says.")
      .def("command_at", &command_at, py::arg("period"), py::arg("simulation"), py::arg("sensed"),
           py::arg("shape"),
           "The same from what stands on a topic and from a shape at the simulation's time.")
      .def_property_readonly(
          "saturated",
          [](const FlownLaw& flown) { return Controller::saturated(flown.state.data()); },
          "Whether the rotors could not do what was asked of them last.");

  py::class_<FlownInnerLoop>(m, "InnerLoop", "An inner loop that flies one vehicle.")
      .def(py::init([](const Self& believed, const Self& flown, const Values& values,
                       const std::vector<double>& spins) {
             refuse_velocity_in_body("inner loop", flown);
             control::InnerLoop made(describe_as(believed, flown), values, spins);
             const std::size_t size = control::InnerLoop::state_size(made.rotors());
             return std::make_unique<FlownInnerLoop>(
                 FlownInnerLoop{std::move(made), std::vector<double>(size)});
           }),
           py::arg("believed"), py::arg("flown"), py::arg("values"), py::arg("spins"))
      .def(
          "attitude",
          [](FlownInnerLoop& flown, double period, const py::object& state,
             const py::object& wanted, double thrust) {
            return flown.command(
                period, odometry(state),
                control::AttitudeThrust{orientation(wanted, "orientation"), thrust});
          },
          py::arg("period"), py::arg("state"), py::arg("orientation"), py::arg("thrust"),
          "Rotor speeds, rad/s, shape (n,), for an orientation (quaternion x, y, z, w) and a "
          "thrust [N].")
      .def(
          "rates",
          [](FlownInnerLoop& flown, double period, const py::object& state,
             const py::object& wanted, double thrust) {
            return flown.command(period, odometry(state),
                                 control::RatesThrust{vector(wanted, "angular_velocity"), thrust});
          },
          py::arg("period"), py::arg("state"), py::arg("angular_velocity"), py::arg("thrust"),
          "Rotor speeds, rad/s, shape (n,), for an angular velocity (body axes, rad/s) and a "
          "thrust [N].");
  m.def("inner_loop", [] { return control::InnerLoop::table(); }, "Parameters of the inner loop.");

  m.def(
      "hover_commands",
      [](const Self& self, const std::vector<double>& spins) {
        return control::hover_commands(describe(self), spins);
      },
      py::arg("simulation"), py::arg("spins"),
      "Speeds with which the vehicle hovers level, signed, rad/s; shape (n,).");
  m.def("start_on", &start, py::arg("simulation"), py::arg("reference"), py::arg("spins"),
        "Members of the state of a vehicle that follows a reference exactly.");
  m.def("timing", &control::timing_table, "When a controller is called, and how late it acts.");
  m.def(
      "is_timing",
      [](const std::string& name, double value) {
        try {
          control::check_values("", control::timing_table(), {{name, value}});
        } catch (const InputError&) {
          return false;
        }
        return true;
      },
      py::arg("name"), py::arg("value"), "Whether this can be one of timing().");
  m.def(
      "read_gains",
      [](const std::string& path) {
        const control::Gains gains = control::read_gains(path);
        return py::make_tuple(gains.law, gains.vehicle, gains.rate, gains.delay, gains.values);
      },
      py::arg("path"), "Law, vehicle, rate, delay and parameters of a gains file.");
  m.def(
      "controllers",
      [] {
        py::list all;
        for (const control::LawInfo& law : control::laws()) {
          all.append(py::make_tuple(law.name, law.summary, Controller::table(law.name)));
        }
        return all;
      },
      "Name, summary and parameters of every law.");
}

}  // namespace quadcore::bindings
