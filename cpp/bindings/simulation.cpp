#include "quadcore/simulation.hpp"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>

#include "bindings.hpp"
#include "quadcore/error.hpp"
#include "quadcore/flight.hpp"
#include "quadcore/plugin_library.hpp"

namespace quadcore::bindings {
namespace {

/// Signals are looked at about this often during a long step().
constexpr std::chrono::milliseconds between_signals(20);

/// A simulation that refuses to be used by two Python threads at once: the GIL does not guard it
/// while it steps.
struct Guarded {
  Simulation simulation;
  std::atomic<bool> busy{false};

  Guarded(const Model& model, const World& world, const SimulationOptions& options)
      : simulation(model, world, options) {}
};

class Lock {
 public:
  explicit Lock(Guarded& guarded) : guarded_(guarded) {
    if (guarded.busy.exchange(true)) {
      throw InputError("this simulation is being used by another thread; give each its own");
    }
  }
  ~Lock() { guarded_.busy = false; }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  Guarded& guarded_;
};

/// Raises in Python, as warnings, what a simulation warns of during a call, also where that fails.
template <class Call>
void raising_warnings(const Simulation& simulation, const Call& call) {
  const std::size_t before = simulation.warnings().size();
  const auto raise = [&] {
    for (std::size_t i = before; i < simulation.warnings().size(); ++i) {
      const py::object category = py::module_::import("quadcore").attr("QuadcoreWarning");
      if (PyErr_WarnEx(category.ptr(), simulation.warnings()[i].c_str(), 1) != 0) {
        throw py::error_already_set();  // the user has made an error of it
      }
    }
  };
  try {
    call();
  } catch (...) {
    raise();
    throw;
  }
  if (simulation.warnings().size() > before) raise();
}

struct BoundFlight {
  std::shared_ptr<Guarded> guarded;
  Flight flight;
};

std::shared_ptr<Guarded> create(const Model& model, const World& world, std::string engine,
                                std::optional<double> dt, std::uint64_t seed,
                                std::map<std::string, std::string> parameters,
                                const std::array<double, 6>& spawn) {
  SimulationOptions options{std::move(engine), dt, seed, std::move(parameters), {}};
  options.spawn.xyz = {spawn[0], spawn[1], spawn[2]};
  options.spawn.rpy = {spawn[3], spawn[4], spawn[5]};
  return std::make_shared<Guarded>(model, world, options);
}

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

Numbers numbers(const py::object& object, int dimensions, const char* what) {
  Numbers array = Numbers::ensure(object);
  if (!array) PyErr_Clear();
  if (!array || array.ndim() != dimensions) {
    throw InputError(std::string(what) + " is not " +
                     (dimensions == 0
                          ? "a number"
                          : "a " + std::to_string(dimensions) + "-dimensional array of numbers"));
  }
  return array;
}

void command(Guarded& guarded, const py::object& speeds) {
  const Numbers array = numbers(speeds, 1, "command");
  const Lock lock(guarded);
  guarded.simulation.command(array.data(), static_cast<std::size_t>(array.size()));
}

void step(Guarded& guarded, std::int64_t n) {
  using Clock = std::chrono::steady_clock;
  const Lock lock(guarded);
  // A single step is over sooner than the GIL is handed over and back.
  if (n == 1) return raising_warnings(guarded.simulation, [&] { guarded.simulation.step(); });
  do {
    raising_warnings(guarded.simulation, [&] {
      const py::gil_scoped_release release;
      const Clock::time_point begin = Clock::now();
      std::int64_t piece = 1;  // grows, because a step may take a microsecond or a second
      do {
        piece = std::min(n, 2 * piece);
        guarded.simulation.step(piece);
        n -= piece;
      } while (n > 0 && Clock::now() - begin < between_signals);
    });
    if (n > 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
  } while (n > 0);
}

/// Read-only arrays onto the simulation's own state. They own a share of the simulation, not of its
/// Python object, so that no reference cycle keeps it alive.
py::dict views(const std::shared_ptr<Guarded>& guarded) {
  const auto view = [&guarded](const double* data, Eigen::Index size) {
    const py::capsule owner(new std::shared_ptr<Guarded>(guarded), [](void* share) {
      delete static_cast<std::shared_ptr<Guarded>*>(share);
    });
    py::array_t<double> array(static_cast<py::ssize_t>(size), data, owner);
    array.attr("flags").attr("writeable") = false;
    return array;
  };
  const VehicleState& s = guarded->simulation.state();
  py::dict result;
  result["time"] = view(&s.time, 1);
  result["position"] = view(s.position.data(), 3);
  result["orientation"] = view(s.orientation.coeffs().data(), 4);
  result["linear_velocity"] = view(s.linear_velocity.data(), 3);
  result["angular_velocity"] = view(s.angular_velocity.data(), 3);
  result["rotor_velocity"] = view(s.rotor_velocity.data(), s.rotor_velocity.size());
  result["rotor_angle"] = view(s.rotor_angle.data(), s.rotor_angle.size());
  return result;
}

VehicleState to_state(const py::object& object) {
  const auto vector = [&object](const char* name) -> VectorXd {
    const Numbers array = numbers(object.attr(name), 1, (std::string("state.") + name).c_str());
    return Eigen::Map<const VectorXd>(array.data(), array.size());
  };
  const auto sized = [&vector](const char* name, Eigen::Index size) -> VectorXd {
    VectorXd v = vector(name);
    if (v.size() != size) {
      throw InputError(std::string("state.") + name + " holds " + std::to_string(v.size()) +
                       " numbers; give " + std::to_string(size));
    }
    return v;
  };
  VehicleState state;
  state.time = *numbers(object.attr("time"), 0, "state.time").data();
  state.position = sized("position", 3);
  state.orientation.coeffs() = sized("orientation", 4);
  state.linear_velocity = sized("linear_velocity", 3);
  state.angular_velocity = sized("angular_velocity", 3);
  state.rotor_velocity = vector("rotor_velocity");
  state.rotor_angle = vector("rotor_angle");
  return state;
}

std::unique_ptr<BoundFlight> create_flight(const std::shared_ptr<Guarded>& guarded,
                                           const py::object& commands, std::int64_t log_every) {
  std::optional<Commands> table;
  if (!commands.is_none()) {
    const Numbers rows = numbers(commands, 2, "commands");
    table.emplace(Eigen::Map<const Commands::Table>(rows.data(), rows.shape(0), rows.shape(1)),
                  guarded->simulation.command_width());
  }
  const Lock lock(*guarded);
  return std::make_unique<BoundFlight>(
      BoundFlight{guarded, Flight(guarded->simulation, std::move(table), log_every)});
}

void advance(BoundFlight& bound, std::int64_t n) {
  const Lock lock(*bound.guarded);
  raising_warnings(bound.guarded->simulation, [&] {
    const py::gil_scoped_release release;
    bound.flight.advance(n);
  });
}

py::array_t<double> copied(const std::vector<double>& data, std::vector<py::ssize_t> shape) {
  return py::array_t<double>(std::move(shape), data.data());
}

void bind_plugins(py::module_& m) {
  py::class_<Parameter>(m, "ParameterInfo", "One effective parameter of a plugin.")
      .def_property_readonly("name", [](const Parameter& p) { return p.spec.name; })
      .def_property_readonly(
          "value", [](const Parameter& p) { return p.text.empty() ? p.spec.absent : p.text; })
      .def_property_readonly("unit", [](const Parameter& p) { return p.spec.unit; })
      .def_property_readonly("default",
                             [](const Parameter& p) -> std::optional<std::string> {
                               if (p.spec.required) return std::nullopt;
                               return p.spec.fallback.empty() ? p.spec.absent : p.spec.fallback;
                             })
      .def_property_readonly("range", [](const Parameter& p) { return p.spec.range(); })
      .def_property_readonly("meaning", [](const Parameter& p) { return p.spec.meaning; })
      .def_property_readonly("equation", [](const Parameter& p) { return p.spec.equation; })
      .def_property_readonly("alias", [](const Parameter& p) { return p.spec.alias; })
      .def_readonly("origin", &Parameter::origin);

  py::class_<LoadedPlugin>(m, "PluginInfo", "A loaded plugin.")
      .def_readonly("name", &LoadedPlugin::name)
      .def_readonly("filename", &LoadedPlugin::filename)
      .def_readonly("path", &LoadedPlugin::path)
      .def_property_readonly("summary", [](const LoadedPlugin& p) { return p.descriptor->summary; })
      .def_property_readonly("parameters",
                             [](const LoadedPlugin& p) { return p.parameters.all(); });
}

}  // namespace

void bind_simulation(py::module_& m) {
  bind_plugins(m);
  py::class_<Snapshot>(m, "Snapshot", "Everything that the future of a simulation depends on.");

  const auto sim = [](const Guarded& g) -> const Simulation& { return g.simulation; };
  py::class_<Guarded, std::shared_ptr<Guarded>>(m, "Simulation", py::dynamic_attr())
      .def(py::init(&create), py::arg("model"), py::arg("world"), py::arg("engine"), py::arg("dt"),
           py::arg("seed"), py::arg("parameters"), py::arg("spawn"))
      .def("command", &command, py::arg("speeds"))
      .def("step", &step, py::arg("n") = 1)
      .def(
          "set_state",
          [](Guarded& g, const py::object& state) {
            const Lock lock(g);
            const VehicleState wanted = to_state(state);
            raising_warnings(g.simulation, [&] { g.simulation.set_state(wanted); });
          },
          py::arg("state"))
      .def("snapshot",
           [](Guarded& g) {
             const Lock lock(g);
             return g.simulation.snapshot();
           })
      .def(
          "restore",
          [](Guarded& g, const Snapshot& snapshot) {
            const Lock lock(g);
            g.simulation.restore(snapshot);
          },
          py::arg("snapshot"))
      .def("reset",
           [](Guarded& g) {
             const Lock lock(g);
             g.simulation.reset();
           })
      .def_property_readonly("time", [sim](const Guarded& g) { return sim(g).time(); })
      .def_property_readonly("dt", [sim](const Guarded& g) { return sim(g).dt(); })
      .def_property_readonly("engine", [sim](const Guarded& g) { return sim(g).engine_name(); })
      .def_property_readonly("method", [sim](const Guarded& g) { return sim(g).method(); })
      .def_property_readonly("model", [sim](const Guarded& g) { return sim(g).model(); })
      .def_property_readonly("warnings", [sim](const Guarded& g) { return sim(g).warnings(); })
      .def_property_readonly("ignored", [sim](const Guarded& g) { return sim(g).ignored(); })
      .def_property_readonly(
          "plugins", [](const Guarded& g) { return &g.simulation.plugins(); },
          py::return_value_policy::reference_internal)
      .def_property_readonly("rotor_count",
                             [sim](const Guarded& g) { return sim(g).model().joints.size(); })
      .def_property_readonly("rotor_names",
                             [sim](const Guarded& g) { return sim(g).model().joint_names(); })
      .def_property_readonly("command_width",
                             [sim](const Guarded& g) { return sim(g).command_width(); })
      .def_property_readonly(
          "mass", [sim](const Guarded& g) { return mass_properties(sim(g).model()).mass; })
      .def_property_readonly(
          "center_of_mass",
          [sim](const Guarded& g) -> Vector3d { return mass_properties(sim(g).model()).p_FCcm; })
      .def_property_readonly(
          "inertia",
          [sim](const Guarded& g) { return mass_properties(sim(g).model()).inertia_Ccm_F; })
      .def_property_readonly("wrench_terms",
                             [sim](const Guarded& g) { return sim(g).wrench_terms(); })
      .def(
          "topic",
          [sim](const Guarded& g, const std::string& name) {
            const Topics& topics = sim(g).topics();
            const int index = topics.find(name);
            if (index < 0) throw InputError("topic '" + name + "' is not declared by any plugin");
            const Topic& topic = topics[static_cast<std::size_t>(index)];
            py::dict message;
            message["stamp"] = topic.stamp;
            message["count"] = static_cast<std::int64_t>(topic.count);
            for (std::size_t i = 0; i < topic.fields.size(); ++i) {
              message[py::str(topic.fields[i])] = topic.values[i];
            }
            return message;
          },
          py::arg("name"))
      .def("_views", [](const std::shared_ptr<Guarded>& g) { return views(g); });

  py::class_<BoundFlight>(m, "Flight", "One logged run, advanced piece by piece.")
      .def(py::init(&create_flight), py::arg("simulation"), py::arg("commands"),
           py::arg("log_every"))
      .def("advance", &advance, py::arg("n"))
      .def_property_readonly("table",
                             [](const BoundFlight& b) {
                               const Lock lock(*b.guarded);
                               const py::ssize_t rows = b.flight.rows();
                               const auto& data = b.flight.table();
                               return copied(data,
                                             {rows, static_cast<py::ssize_t>(data.size()) / rows});
                             })
      .def_property_readonly("wrenches", [](const BoundFlight& b) {
        const Lock lock(*b.guarded);
        const auto& terms = b.guarded->simulation.wrench_terms();
        return copied(b.flight.wrenches(),
                      {b.flight.rows(), static_cast<py::ssize_t>(terms.size()), 6});
      });

  m.def("log_columns", &log_columns, py::arg("rotor_count"));
  m.def("log_remark", &log_remark, py::arg("ignored"));
  m.def(
      "load_plugin_path",
      [](const py::object& folder) {
        const py::object path = py::module_::import("os").attr("fspath")(folder);
        load_plugin_path(py::cast<std::string>(path));
      },
      py::arg("folder"), "Adds a folder to search for plugin libraries, before all others.");
  m.def("plugin_folders", &plugin_folders, "The folders searched for plugins, in order.");
  m.def("engines", [] {
    std::vector<std::pair<std::string, std::string>> list;
    for (const EngineInfo& info : engines()) list.emplace_back(info.name, info.summary);
    return list;
  });
}

}  // namespace quadcore::bindings
