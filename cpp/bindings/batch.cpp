#include "quadcore/batch.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "arguments.hpp"
#include "bindings.hpp"
#include "controller.hpp"
#include "guarded.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::bindings {
namespace {

/// Number of single-vehicle steps between checks for signals, some hundredths of a second. Checking
/// after each step of many vehicles would load their data into the cache each time.
constexpr std::int64_t between_signals = 100000, steps_between_signals = 10;

constexpr char vehicle_number[] = "vehicle";

/// A batch that rejects simultaneous use by two Python threads.
struct GuardedBatch {
  Batch batch;
  std::atomic<bool> busy{false};
};

class BatchLock {
 public:
  explicit BatchLock(GuardedBatch& guarded) : guarded_(guarded) {
    if (guarded.busy.exchange(true)) {
      throw InputError(
          "this batch is in use by another thread. Use a separate batch for each thread.");
    }
  }
  ~BatchLock() { guarded_.busy = false; }
  BatchLock(const BatchLock&) = delete;
  BatchLock& operator=(const BatchLock&) = delete;

 private:
  GuardedBatch& guarded_;
};

using Seeds = py::array_t<std::uint64_t, py::array::c_style>;

Shape row_of_each(const GuardedBatch& self) {
  return {static_cast<py::ssize_t>(self.batch.size())};
}

Shape rows_of_each(const GuardedBatch& self, std::size_t width) {
  return {static_cast<py::ssize_t>(self.batch.size()), static_cast<py::ssize_t>(width)};
}

std::shared_ptr<GuardedBatch> create_batch(
    const std::vector<Built<Model>>& models, const Built<World>& world, std::string engine,
    std::optional<double> dt, const std::vector<std::map<std::string, std::string>>& parameters,
    const Numbers& spawn, const Seeds& seeds, unsigned threads) {
  const auto n = static_cast<py::ssize_t>(models.size());
  if (parameters.size() != models.size()) {
    throw InputError("there are " + std::to_string(models.size()) + " models, but parameters for " +
                     std::to_string(parameters.size()) +
                     " vehicles. Give one set of parameters for each model.");
  }
  check_shape(spawn, {n, 6}, "spawn");
  check_shape(seeds, {n}, "seeds");
  std::vector<BatchVehicle> vehicles;
  const auto places = spawn.unchecked<2>();
  const auto numbers = seeds.unchecked<1>();
  for (std::size_t i = 0; i < models.size(); ++i) {
    BatchVehicle vehicle{models[i].held, parameters[i], {}, numbers(static_cast<py::ssize_t>(i))};
    for (py::ssize_t k = 0; k < 3; ++k) {
      vehicle.spawn.xyz[k] = places(static_cast<py::ssize_t>(i), k);
      vehicle.spawn.rpy[k] = places(static_cast<py::ssize_t>(i), k + 3);
    }
    vehicles.push_back(std::move(vehicle));
  }
  SimulationOptions options;
  options.engine = std::move(engine);
  options.dt = dt;
  std::shared_ptr<GuardedBatch> made;
  without_gil([&] {
    made = std::shared_ptr<GuardedBatch>(
        new GuardedBatch{Batch(std::move(vehicles), *world, options, threads)});
  });
  return made;
}

void step(GuardedBatch& self, const py::object& commands, std::int64_t steps) {
  Numbers rows;
  if (!commands.is_none()) {
    rows = numbers(commands, 2, "commands");
    check_shape(rows, rows_of_each(self, self.batch.command_width()), "commands");
  }
  const BatchLock lock(self);
  const double* row = commands.is_none() ? nullptr : rows.data();
  const std::int64_t piece = std::max(
      steps_between_signals, between_signals / static_cast<std::int64_t>(self.batch.size()));
  do {
    const std::int64_t now = std::min(steps, piece);
    without_gil([&] { self.batch.step(row, now); });
    row = nullptr;
    steps -= now;
    if (steps > 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
  } while (steps > 0);
}

template <class Get>
auto of_each(const GuardedBatch& self, const Get& get) {
  py::array_t<decltype(get(std::size_t{0}))> values(static_cast<py::ssize_t>(self.batch.size()));
  for (std::size_t i = 0; i < self.batch.size(); ++i) values.mutable_data()[i] = get(i);
  return values;
}

/// Return an array of each flight.
py::list arrays(const std::vector<BatchGuided>& guided, std::vector<double> BatchGuided::* member) {
  py::list list;
  for (const BatchGuided& flight : guided) {
    const std::vector<double>& numbers = flight.*member;
    list.append(py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data()));
  }
  return list;
}

/// Return the number of logged rows, the first of which is the start.
py::ssize_t count_rows(std::int64_t steps, std::int64_t log_every) {
  if (steps < 0 || log_every < 1) {
    throw InputError("steps or log_every is out of range. Give steps >= 0 and log_every >= 1.");
  }
  return static_cast<py::ssize_t>(steps / log_every + 1);
}

/// Fly all vehicles under built-in controllers; returns logs, numbers of rows, calls and saturated
/// calls, and for each flight the variation of rates and commands and the durations of some calls.
py::tuple follow(GuardedBatch& self, const std::vector<BoundController*>& controllers,
                 const std::vector<control::ReferenceShape*>& references, const Numbers& rates,
                 const Numbers& delays, const std::string& odometry, std::int64_t steps,
                 std::int64_t log_every, const std::vector<std::size_t>& logged) {
  const std::size_t n = self.batch.size();
  check_shape(rates, row_of_each(self), "rates");
  check_shape(delays, row_of_each(self), "delays");
  if (controllers.size() != n || references.size() != n) {
    throw InputError("there are not as many controllers and references as vehicles.");
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (!controllers[i] || !references[i]) throw InputError("a controller or reference is None.");
  }
  const py::ssize_t rows = count_rows(steps, log_every);
  const auto columns = static_cast<py::ssize_t>(self.batch.log_width());
  py::array_t<double> logs({static_cast<py::ssize_t>(logged.size()), rows, columns});
  std::vector<BatchGuide> guides;
  std::vector<BatchGuided> guided(n);
  for (std::size_t i = 0; i < n; ++i) {
    guides.push_back({&controllers[i]->controller.controller(), references[i], rates.data()[i],
                      delays.data()[i]});
  }
  for (std::size_t k = 0; k < logged.size(); ++k) {
    double*& log = guided.at(logged[k]).log;
    if (log) {
      throw InputError("logged lists vehicle " + std::to_string(logged[k]) +
                       " twice. List each vehicle once.");
    }
    log = logs.mutable_data() + static_cast<py::ssize_t>(k) * rows * columns;
  }
  const BatchLock lock(self);
  without_gil([&] {
    self.batch.follow(guides, odometry, steps, log_every, guided, [] {
      const py::gil_scoped_acquire gil;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    });
  });
  const auto count = [&](std::int64_t BatchGuided::* member) {
    return of_each(self, [&](std::size_t i) { return guided[i].*member; });
  };
  return py::make_tuple(
      logs, count(&BatchGuided::rows), count(&BatchGuided::calls), count(&BatchGuided::saturated),
      arrays(guided, &BatchGuided::rate_variation), arrays(guided, &BatchGuided::command_variation),
      arrays(guided, &BatchGuided::seconds));
}

/// Fly all vehicles under one function that returns all speeds; returns logs, numbers of rows, and
/// for each flight the variation of rates and commands.
py::tuple follow_together(GuardedBatch& self, const py::function& function, double rate,
                          double delay, const std::string& odometry, std::int64_t steps,
                          std::int64_t log_every) {
  const auto n = static_cast<py::ssize_t>(self.batch.size());
  const py::ssize_t rows = count_rows(steps, log_every);
  const auto columns = static_cast<py::ssize_t>(self.batch.log_width());
  py::array_t<double> logs({n, rows, columns});
  std::vector<BatchGuided> guided(self.batch.size());
  for (py::ssize_t i = 0; i < n; ++i) {
    guided[static_cast<std::size_t>(i)].log = logs.mutable_data() + i * rows * columns;
  }
  const auto call = [&](double time, const double* measured, double* speeds) {
    const py::gil_scoped_acquire gil;
    const py::array_t<double> states({n, static_cast<py::ssize_t>(Batch::odometry_width)},
                                     measured);
    const Numbers answer = numbers(function(time, states), 2, "command");
    check_shape(answer, rows_of_each(self, self.batch.command_width()), "command");
    std::copy_n(answer.data(), answer.size(), speeds);
  };
  const BatchLock lock(self);
  without_gil(
      [&] { self.batch.follow_together(call, rate, delay, odometry, steps, log_every, guided); });
  return py::make_tuple(logs, of_each(self, [&](std::size_t i) { return guided[i].rows; }),
                        arrays(guided, &BatchGuided::rate_variation),
                        arrays(guided, &BatchGuided::command_variation));
}

void write_state(GuardedBatch& self, const py::object& out) {
  double* const rows = writable(out, rows_of_each(self, self.batch.state_width()), "out");
  const BatchLock lock(self);
  without_gil([&] { self.batch.get_state(rows); });
}

void take_state(GuardedBatch& self, const py::object& states) {
  const Numbers rows = numbers(states, 2, "states");
  check_shape(rows, rows_of_each(self, self.batch.state_width()), "states");
  const BatchLock lock(self);
  without_gil([&] { self.batch.set_state(rows.data()); });
}

void reset(GuardedBatch& self, const py::object& mask, const std::optional<Seeds>& seeds) {
  using Flags = py::array_t<bool, py::array::c_style>;
  const py::array given = py::array::ensure(mask);
  if (!given || !py::isinstance<py::array_t<bool>>(given)) {
    throw InputError("mask is not an array of booleans. Give one boolean for each vehicle.");
  }
  check_shape(given, row_of_each(self), "mask");
  if (seeds) check_shape(*seeds, row_of_each(self), "seeds");
  const Flags flags(given);
  const BatchLock lock(self);
  self.batch.reset(flags.data(), seeds ? seeds->data() : nullptr);
}

}  // namespace

void bind_batch(py::module_& m) {
  py::class_<BatchSnapshot, std::shared_ptr<BatchSnapshot>>(m, "BatchSnapshot",
                                                            "Complete state of a batch.");
  py::class_<GuardedBatch, std::shared_ptr<GuardedBatch>>(
      m, "Batch", "Several vehicles that are stepped together; use quadcore.BatchSimulation.")
      .def(py::init(&create_batch), py::arg("models"), py::arg("world"), py::arg("engine"),
           py::arg("dt"), py::arg("parameters"), py::arg("spawn"), py::arg("seeds"),
           py::arg("threads"))
      .def("step", &step, py::arg("commands"), py::arg("steps"),
           "Advance all vehicles that have not failed. Commands have the shape (n, rotors) in "
           "rad/s; None keeps the previous ones.")
      .def("_follow", &follow, py::arg("controllers"), py::arg("references"), py::arg("rates"),
           py::arg("delays"), py::arg("odometry"), py::arg("steps"), py::arg("log_every"),
           py::arg("logged"))
      .def("_follow_together", &follow_together, py::arg("function"), py::arg("rate"),
           py::arg("delay"), py::arg("odometry"), py::arg("steps"), py::arg("log_every"))
      .def("_write_state", &write_state, py::arg("out"))
      .def("_take_state", &take_state, py::arg("states"))
      .def("reset", &reset, py::arg("mask"), py::arg("seeds"),
           "Reset the vehicles selected by a mask to their start, with new seeds unless None.")
      .def(
          "snapshot",
          [](GuardedBatch& self) {
            const BatchLock lock(self);
            return self.batch.snapshot();
          },
          "Return the complete state of every vehicle for `restore`.")
      .def(
          "restore",
          [](GuardedBatch& self, const Built<BatchSnapshot>& snapshot) {
            const BatchLock lock(self);
            self.batch.restore(*snapshot);
          },
          py::arg("snapshot"),
          R"(Go back to a snapshot, bit for bit.

Parameters
----------
snapshot : BatchSnapshot
    Of this batch, as `snapshot()` gave it.

Raises
------
InputError
    It was taken of another; nothing has changed then.)")
      .def_property_readonly(
          "n", [](const GuardedBatch& self) { return self.batch.size(); }, "Number of vehicles.")
      .def_property_readonly(
          "dt", [](const GuardedBatch& self) { return self.batch.dt(); }, "Time step, s.")
      .def_property_readonly(
          "command_width", [](const GuardedBatch& self) { return self.batch.command_width(); },
          "Number of values in a vehicle's command.")
      .def_property_readonly(
          "state_width", [](const GuardedBatch& self) { return self.batch.state_width(); },
          "Number of values in a vehicle's state, 13 + 2 rotors.")
      .def_property_readonly(
          "log_width", [](const GuardedBatch& self) { return self.batch.log_width(); },
          "Number of values in a row of a log: the time, and the state without joint angles.")
      .def_property_readonly(
          "time",
          [](GuardedBatch& self) {
            const BatchLock lock(self);
            return of_each(self, [&](std::size_t i) { return self.batch.time(i); });
          },
          "Simulation time of each vehicle, s; shape (n,).")
      .def_property_readonly(
          "failures",
          [](GuardedBatch& self) {
            const BatchLock lock(self);
            return self.batch.failures();
          },
          "Reason why each flight failed, list of str; \"\" while it continues.")
      .def(
          "warnings",
          [](GuardedBatch& self, const Given<std::int64_t, vehicle_number>& vehicle) {
            const BatchLock lock(self);
            const auto n = static_cast<std::int64_t>(self.batch.size());
            if (vehicle.value < 0 || vehicle.value >= n) {
              throw InputError("vehicle is " + std::to_string(vehicle.value) +
                               ". Give a number from 0 to " + std::to_string(n - 1) + ".");
            }
            return self.batch.warnings(static_cast<std::size_t>(vehicle.value));
          },
          py::arg("vehicle"), R"(Return the warnings about a vehicle's flight, list of str.

Parameters
----------
vehicle : int
    Counted from 0.

Raises
------
InputError
    If there is no such vehicle.)");
}

}  // namespace quadcore::bindings
