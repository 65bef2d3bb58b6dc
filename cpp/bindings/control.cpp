#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "arguments.hpp"
#include "bindings.hpp"
#include "controller.hpp"
#include "odometry.hpp"
#include "quadcore/control/gains_file.hpp"
#include "quadcore/control/inner_loop.hpp"
#include "quadcore/control/modelled_vehicle_file.hpp"
#include "quadcore/control/start.hpp"
#include "reference.hpp"

namespace quadcore::bindings {
namespace {

using control::Controller;
using control::Values;

/// An inner loop and its memory.
struct BoundInnerLoop {
  control::InnerLoop loop;
  std::vector<double> state;

  template <class Wanted>
  py::array_t<double> command(double period, const messages::Odometry& now, const Wanted& wanted) {
    py::array_t<double> speeds(static_cast<py::ssize_t>(loop.rotors()));
    loop.command(period, now, wanted, state.data(), speeds.mutable_data());
    return speeds;
  }
};

VehicleDescription describe(const Self& self) {
  const Lock lock(*self);
  return self->describe_vehicle();
}

void refuse_velocity_in_body(const std::string& who, const Self& flown) {
  if (!flown->has_velocity_in_body()) return;
  throw InputError(who + " requires velocities in world axes. Set <twistFrame> to world.");
}

/// Return the description of the modelled vehicle, which may be the simulated one, with the
/// latter's command order.
VehicleDescription describe_model(const Self& believed, const Self& flown,
                                  const VehicleDescription& description) {
  if (&*believed == &*flown) return description;
  return control::match_rotors(description, describe(believed), "the modelled vehicle ");
}

Vector3d vector(const py::object& object, const char* what) {
  const Numbers array = numbers(object, 1, what);
  if (array.size() != 3)
    throw InputError(std::string(what) + " does not have three numbers. Give x, y, z.");
  check_finite(array.data(), 3, what);
  return Eigen::Map<const Vector3d>(array.data());
}

Quaterniond orientation(const py::object& object, const char* what) {
  const Numbers array = numbers(object, 1, what);
  if (array.size() != 4)
    throw InputError(std::string(what) +
                     " does not have four numbers. Give a quaternion x, y, z, w.");
  check_finite(array.data(), 4, what);
  return Quaterniond(Eigen::Map<const Eigen::Vector4d>(array.data()));
}

messages::Odometry odometry(const py::object& state) {
  if (py::isinstance<BoundOdometry>(state)) return state.cast<const BoundOdometry&>().message;
  messages::Odometry now;
  now.position = vector(state.attr("position"), "state.position");
  now.orientation = orientation(state.attr("orientation"), "state.orientation");
  now.linear_velocity = vector(state.attr("linear_velocity"), "state.linear_velocity");
  now.angular_velocity = vector(state.attr("angular_velocity"), "state.angular_velocity");
  return now;
}

std::unique_ptr<BoundController> create_controller(const std::string& name, const Self& believed,
                                                   const Self& flown, const Values& values,
                                                   const std::vector<double>& spins) {
  refuse_velocity_in_body("controller '" + name + "'", flown);
  const VehicleDescription description = describe(flown);
  Controller made(name, describe_model(believed, flown, description), values, spins);
  return std::make_unique<BoundController>(BoundController{
      flown, control::GuidedController(*flown.operator->(), std::move(made), description)});
}

py::array_t<double> command(BoundController& bound, double period, const py::object& state,
                            const py::object& wanted) {
  const messages::Odometry now = odometry(state);
  const messages::Reference reference = to_reference(wanted);
  py::array_t<double> speeds(static_cast<py::ssize_t>(bound.controller.rotors()));
  const Lock lock(*bound.flown);
  bound.controller.command(period, now, reference, speeds.mutable_data());
  return speeds;
}

py::dict modelled_vehicle(const Self& self, const Values& values,
                          const std::vector<double>& spins) {
  control::check_values("vehicle", control::ModelledVehicle::table(), values);
  const auto model = control::ModelledVehicle::of(describe(self), spins, values);
  const auto n = static_cast<Eigen::Index>(model.rotors.size());
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> axes(n, 3);
  VectorXd directions(n), momenta(n), lags(n), slowest(n), fastest(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const control::ModelledRotor& rotor = model.rotors[static_cast<std::size_t>(i)];
    axes.row(i) = rotor.axis_F.transpose();
    directions[i] = rotor.spin;
    momenta[i] = rotor.momentum;
    lags[i] = rotor.lag;
    slowest[i] = rotor.slowest;
    fastest[i] = rotor.fastest;
  }
  py::dict members;
  members["mass"] = model.mass;
  members["gravity"] = model.gravity;
  members["center_of_mass"] = model.p_FCcm_F;
  members["inertia"] = model.inertia_Ccm_F;
  members["effectiveness"] = Eigen::MatrixXd(model.effectiveness);
  members["axes"] = axes;
  members["spins"] = directions;
  members["angular_momenta"] = momenta;
  members["time_constants"] = lags;
  members["min_speeds"] = slowest;
  members["max_speeds"] = fastest;
  return members;
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
  py::class_<TagSpec>(m, "ParameterSpec", "Parameter of a controller or a reference.")
      .def_readonly("name", &TagSpec::name, "Name of the parameter.")
      .def_readonly("unit", &TagSpec::unit, "Unit, or \"\".")
      .def_readonly("default", &TagSpec::fallback, "Default value as text.")
      .def_readonly("meaning", &TagSpec::meaning, "Meaning in one line.")
      .def_readonly("equation", &TagSpec::equation, "Equation or source, or \"\".")
      .def_property_readonly(
          "is_flag", [](const TagSpec& spec) { return spec.kind == TagKind::flag; },
          "Whether the parameter is a boolean.")
      .def_property_readonly(
          "range", [](const TagSpec& spec) { return spec.range(); },
          "Valid values as readable text.");

  py::class_<BoundController>(m, "Controller", "Built-in controller of one vehicle.")
      .def(py::init(&create_controller), py::arg("name"), py::arg("believed"), py::arg("flown"),
           py::arg("values"), py::arg("spins"))
      .def("command", &command, py::arg("period"), py::arg("state"), py::arg("reference"),
           "Return the rotor speeds to command for a period [s], signed, rad/s; shape (n,). The "
           "state has the form of odometry.")
      .def_property_readonly(
          "saturated", [](const BoundController& bound) { return bound.controller.saturated(); },
          "Whether the rotors could not meet the last demand.");

  py::class_<BoundInnerLoop>(m, "InnerLoop", "Attitude and rate controller of one vehicle.")
      .def(py::init([](const Self& believed, const Self& flown, const Values& values,
                       const std::vector<double>& spins) {
             refuse_velocity_in_body("inner loop", flown);
             control::InnerLoop made(describe_model(believed, flown, describe(flown)), values,
                                     spins);
             const std::size_t size = control::InnerLoop::state_size(made.rotors());
             return std::make_unique<BoundInnerLoop>(
                 BoundInnerLoop{std::move(made), std::vector<double>(size)});
           }),
           py::arg("believed"), py::arg("flown"), py::arg("values"), py::arg("spins"))
      .def(
          "attitude",
          [](BoundInnerLoop& flown, double period, const py::object& state,
             const py::object& wanted, double thrust) {
            return flown.command(
                period, odometry(state),
                control::AttitudeThrust{orientation(wanted, "orientation"), thrust});
          },
          py::arg("period"), py::arg("state"), py::arg("orientation"), py::arg("thrust"),
          "Return the rotor speeds, rad/s, shape (n,), for an orientation (quaternion x, y, z, w) "
          "and a thrust [N].")
      .def(
          "rates",
          [](BoundInnerLoop& flown, double period, const py::object& state,
             const py::object& wanted, double thrust) {
            return flown.command(period, odometry(state),
                                 control::RatesThrust{vector(wanted, "angular_velocity"), thrust});
          },
          py::arg("period"), py::arg("state"), py::arg("angular_velocity"), py::arg("thrust"),
          "Return the rotor speeds, rad/s, shape (n,), for an angular velocity (body axes, rad/s) "
          "and a thrust [N].")
      .def(
          "wrench",
          [](BoundInnerLoop& flown, double period, const py::object& state,
             const py::object& wanted, double thrust) {
            return flown.command(period, odometry(state),
                                 control::WrenchThrust{vector(wanted, "torque"), thrust});
          },
          py::arg("period"), py::arg("state"), py::arg("torque"), py::arg("thrust"),
          "Return the rotor speeds, rad/s, shape (n,), for a torque about the centre of mass (body "
          "axes, N m) and a thrust [N].");
  m.def(
      "inner_loop", [] { return control::InnerLoop::table(); },
      "Return the parameters of the inner loop.");

  m.def("modelled_vehicle", &modelled_vehicle, py::arg("simulation"), py::arg("values"),
        py::arg("spins"), "Return a controller's model of a vehicle as arrays by name.");
  m.def(
      "vehicle_model", [] { return control::ModelledVehicle::table(); },
      "Return the parameters of modelled_vehicle().");
  m.def(
      "hover_commands",
      [](const Self& self, const std::vector<double>& spins) {
        return control::hover_commands(describe(self), spins);
      },
      py::arg("simulation"), py::arg("spins"),
      "Return the signed rotor speeds for level hover, rad/s; shape (n,).");
  m.def("start_on", &start, py::arg("simulation"), py::arg("reference"), py::arg("spins"),
        "Return the state members of a vehicle that follows a reference exactly.");
  m.def("timing", &control::timing_table,
        "Return the parameters of a controller's rate and delay.");
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
      py::arg("name"), py::arg("value"),
      "Return whether the value is valid for a parameter of timing().");
  m.def(
      "read_gains",
      [](const std::string& path) {
        const control::Gains gains = control::read_gains(path);
        return py::make_tuple(gains.law, gains.vehicle, gains.rate, gains.delay, gains.values);
      },
      py::arg("path"), "Return controller, vehicle, rate, delay and parameters of a gains file.");
  m.def(
      "controllers",
      [] {
        py::list all;
        for (const control::ControllerInfo& info : control::list_controllers()) {
          all.append(py::make_tuple(info.name, info.summary, Controller::table(info.name)));
        }
        return all;
      },
      "Return name, summary and parameters of every controller.");
}

}  // namespace quadcore::bindings
