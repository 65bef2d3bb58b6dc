#include "quadcore/simulation.hpp"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <chrono>

#include "arguments.hpp"
#include "bindings.hpp"
#include "guarded.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin_library.hpp"
#include "state.hpp"

namespace quadcore::bindings {
namespace {

/// Interval between checks for signals during a long step().
constexpr std::chrono::milliseconds between_signals(20);

std::shared_ptr<Guarded> create_simulation(const Built<Model>& model, const Built<World>& world,
                                           std::string engine, std::optional<double> dt,
                                           std::uint64_t seed,
                                           std::map<std::string, std::string> parameters,
                                           const std::array<double, 6>& spawn) {
  SimulationOptions options{std::move(engine), dt, seed, std::move(parameters), {}};
  options.spawn.xyz = {spawn[0], spawn[1], spawn[2]};
  options.spawn.rpy = {spawn[3], spawn[4], spawn[5]};
  return std::make_shared<Guarded>(*model, *world, options);
}

void set_command(const Self& self, const ArrayLike& speeds) {
  const Numbers array = numbers(speeds, 1, "command");
  const Lock lock(*self, "command()");
  self->command(array.data(), static_cast<std::size_t>(array.size()));
}

constexpr char step_count[] = "steps";

void step(const Self& self, const Given<std::int64_t, step_count>& steps) {
  std::int64_t n = steps.value;
  using Clock = std::chrono::steady_clock;
  refuse_in_fleet(*self, "step()");
  const Lock lock(*self, "step()");
  // A single step takes less time than releasing and reacquiring the GIL.
  if (n == 1) return raising_warnings(*self, [&] { self->step(); });
  do {
    raising_warnings(*self, [&] {
      without_gil([&] {
        const Clock::time_point begin = Clock::now();
        std::int64_t piece = 1;  // grows, because a step takes between a microsecond and a second
        do {
          piece = std::min(n, 2 * piece);
          self->step(piece);
          n -= piece;
        } while (n > 0 && Clock::now() - begin < between_signals);
      });
    });
    if (n > 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
  } while (n > 0);
}

/// Return a getter of a value that a step may change.
template <class Get>
auto locked(const Get& get) {
  return [get](const Self& self) {
    const Lock lock(*self);
    return get(self.guarded->simulation);
  };
}

/// Let Python move the vehicle: motion(dt, command, members) returns the state at the end of a
/// step. An exception that is no Exception, such as KeyboardInterrupt, ends the call that advances
/// the simulation, which then raises it.
void move_by(const Self& self, const py::function& motion) {
  const Lock lock(*self, "_move_by()");
  self->move_by(
      [motion, &guarded = *self](double dt, const VectorXd& command, VehicleState& state) {
        const py::gil_scoped_acquire gil;
        try {
          VehicleState moved = to_state(motion(dt, command, copies(state)));
          if (moved.rotor_velocity.size() != state.rotor_velocity.size() ||
              moved.rotor_angle.size() != state.rotor_angle.size()) {
            throw Error(
                "the motion returned a state with another number of rotors. Return values for each "
                "rotor.");
          }
          state = std::move(moved);
        } catch (const py::error_already_set& error) {
          if (!error.matches(PyExc_Exception)) {
            guarded.interrupt = std::current_exception();
            throw Error("the motion was interrupted");
          }
          throw Error(py::cast<std::string>(py::str(error.value())));
        }
      });
}

}  // namespace

void bind_simulation(py::module_& m) {
  py::class_<Guarded, std::shared_ptr<Guarded>> simulation(
      m, "Simulation", py::dynamic_attr(), "One vehicle in one world; use quadcore.Simulation.");
  simulation
      .def(py::init(&create_simulation), py::arg("model"), py::arg("world"), py::arg("engine"),
           py::arg("dt"), py::arg("seed"), py::arg("parameters"), py::arg("spawn"))
      .def("command", &set_command, py::arg("speeds"),
           R"(Publish rotor speeds, which hold until the next ones.

Parameters
----------
speeds : array_like (n,)
    Signed, before the division by sim_slow, rad/s; n is `command_width`. A positive speed
    turns about the joint's axis by the right-hand rule.

Raises
------
InputError
    Another count, a number that is not finite, a plugin that commands the rotors, or a run in
    progress, in which the controller returns the command. Nothing has changed then.)")
      .def("step", &step, py::arg("n") = 1, R"(Advance by whole steps of `dt`, without the GIL.

Parameters
----------
n : int
    How many.

Raises
------
FlightError
    The flight failed, with `time` and reason; restore, reset and set_state go on from there.
InputError
    Another thread is stepping this simulation, or a run flies it.)")
      .def(
          "set_state",
          [](const Self& self, const StateLike& object) {
            const VehicleState state = to_state(object);
            const Lock lock(*self, "set_state()");
            raising_warnings(*self, [&] { self->set_state(state); });
          },
          py::arg("state"), R"(Move the vehicle into a state; what plugins remember stays.

Parameters
----------
state : State
    As `state.copy()` gives it, or what has the same members.

Raises
------
InputError
    Members of other sizes, a number that is not finite, or a quaternion of length zero. Nothing
    has changed then.)")
      .def(
          "snapshot",
          [](const Self& self) {
            const Lock lock(*self);
            return self->snapshot();
          },
          R"(Take down all that the future depends on.

Returns
-------
Snapshot
    For `restore`; can be pickled.)")
      .def(
          "restore",
          [](const Self& self, const Built<Snapshot>& snapshot,
             const std::vector<std::string>& allow) {
            refuse_in_fleet(*self, "restore()");
            const Lock lock(*self, "restore()");
            self->restore(*snapshot, Allowed::of(allow));
          },
          py::arg("snapshot"), py::arg("allow"),
          "Restore a snapshot; `allow` names the parts that may differ.")
      .def(
          "reset",
          [](const Self& self, const std::optional<std::uint64_t>& seed) {
            refuse_in_fleet(*self, "reset()");
            const Lock lock(*self, "reset()");
            seed ? self->reset(*seed) : self->reset();
          },
          py::arg("seed"),
          "Reset to the state after construction with `seed`; None keeps the seed.")
      .def_property_readonly(
          "time", [](const Self& self) { return self->time(); }, "Simulation time, s.")
      .def_property_readonly(
          "dt", [](const Self& self) { return self->dt(); }, "Time step, s.")
      .def_property_readonly(
          "engine", [](const Self& self) { return self->engine_name(); }, "Name of the engine.")
      .def_property_readonly("method", locked([](const Simulation& s) { return s.method(); }),
                             "Integration method of the engine, in one line.")
      .def_property_readonly("free_bodies",
                             locked([](const Simulation& s) { return s.free_bodies(); }),
                             "Present motion of the world's free bodies, list of FreeBodyState.")
      .def_property_readonly(
          "model", locked([](const Simulation& s) { return s.model(); }),
          "Model as the engine simulates it, including bodies that are attached now.")
      .def_property_readonly("warnings", locked([](const Simulation& s) { return s.warnings(); }),
                             "Warnings about the model and this flight, list of str.")
      .def_property_readonly(
          "ignored", [](const Self& self) { return self->ignored(); },
          "Elements of model and world that the user ignored, and what of the world is not "
          "simulated, list of str.")
      .def_property_readonly(
          "plugins", [](const Self& self) { return &self->plugins(); },
          py::return_value_policy::reference_internal,
          "Loaded plugins in the order of the URDF, list of PluginInfo.")
      .def_property_readonly(
          "rotor_count", [](const Self& self) { return self->rotor_count(); },
          "Number of rotor joints.")
      .def_property_readonly(
          "rotor_names", [](const Self& self) { return self->rotor_names(); },
          "Names of the rotor joints, in the order of all rotor quantities, list of str.")
      .def_property_readonly(
          "command_width", [](const Self& self) { return self->command_width(); },
          "Number of values in a command. Raises InputError if no plugin accepts one.")
      .def_property_readonly(
          "mass", locked([](const Simulation& s) { return mass_properties(s.model()).mass; }),
          "Mass of the whole vehicle, kg.")
      .def_property_readonly("center_of_mass", locked([](const Simulation& s) -> Vector3d {
                               return mass_properties(s.model()).p_FCcm;
                             }),
                             "Centre of mass of the whole vehicle relative to the frame's origin, "
                             "frame axes, m; shape (3,).")
      .def_property_readonly("inertia", locked([](const Simulation& s) {
                               return mass_properties(s.model()).inertia_Ccm_F;
                             }),
                             "Inertia of the whole vehicle including the rotors, about its centre "
                             "of mass, frame axes, kg m^2; shape (3, 3).")
      .def_property_readonly(
          "gravity", [](const Self& self) -> Vector3d { return self->world().gravity_W; },
          "Gravity in world axes, m/s^2; shape (3,).")
      .def_property_readonly(
          "wrench_terms", [](const Self& self) { return self->wrench_terms(); },
          "Names of the wrenches that a log can contain, list of str.")
      .def_property_readonly(
          "in_fleet", [](const Self& self) { return self.guarded->in_fleet; },
          "Whether the vehicle belongs to a fleet, which alone advances it.")
      .def("_views", &views)
      .def("_move_by", &move_by, py::arg("motion"));
  bind_rotors(m, simulation);
  bind_topics(m, simulation);

  m.def(
      "engines",
      [] {
        std::vector<std::pair<std::string, std::string>> list;
        for (const EngineInfo& info : engines()) list.emplace_back(info.name, info.summary);
        return list;
      },
      "Return name and summary of every engine, list of pairs of str.");
}

}  // namespace quadcore::bindings
