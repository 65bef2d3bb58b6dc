#include "flight.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "arguments.hpp"
#include "bindings.hpp"
#include "quadcore/log.hpp"

namespace quadcore::bindings {
namespace {

/// The duration of a run, in which only the run may advance the simulation.
class Run {
 public:
  explicit Run(const Self& self) : guarded_(self.guarded) { const Lock lock(*guarded_, "run()"); }
  ~Run() { end(); }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  void begin() {
    const Lock lock(*guarded_, "run()");
    guarded_->flown_by = PyThread_get_thread_ident();
    is_begun_ = true;
  }
  void end() {
    if (is_begun_) guarded_->flown_by.reset();
    is_begun_ = false;
  }

 private:
  std::shared_ptr<Guarded> guarded_;
  bool is_begun_ = false;
};

/// Return the column names of a flight that logs these topics.
std::vector<std::string> columns(const Self& self, const std::vector<std::string>& topics) {
  std::vector<std::string> names = log_columns(self->model().joints.size());
  for (const std::size_t topic : self->topics().at(topics)) {
    const std::vector<std::string> of_topic = log_columns(self->topics()[topic]);
    names.insert(names.end(), of_topic.begin(), of_topic.end());
  }
  return names;
}

std::unique_ptr<BoundFlight> create_flight(const Self& self, const py::object& commands,
                                           std::int64_t log_every, bool wrenches,
                                           const std::vector<std::string>& topics,
                                           std::size_t to_fill) {
  std::optional<Commands> table;
  if (!commands.is_none()) {
    const Numbers rows = numbers(commands, 2, "commands");
    table.emplace(Eigen::Map<const Commands::Table>(rows.data(), rows.shape(0), rows.shape(1)),
                  self->command_width());
  }
  const Lock lock(*self);
  return std::make_unique<BoundFlight>(BoundFlight{
      self.guarded,
      Flight(*self.operator->(), std::move(table), log_every, wrenches, topics, to_fill),
      static_cast<py::ssize_t>(columns(self, topics).size() + to_fill)});
}

/// Returns the number of steps taken, or in a fleet the number until the next command.
std::int64_t advance(BoundFlight& bound, std::int64_t n) {
  const Lock lock(*bound.guarded);
  if (bound.guarded->in_fleet) return bound.flight.prepare(n);
  raising_warnings(*bound.guarded, [&] {
    without_gil([&] {
      bound.flight.make_room(n);
      bound.flight.advance(n);
    });
  });
  return n;
}

/// Return an array that owns the numbers, because a log is too large to copy.
py::array_t<double> array_of(std::vector<double>&& numbers, std::vector<py::ssize_t> shape) {
  auto* const owned = new std::vector<double>(std::move(numbers));
  const py::capsule owner(owned,
                          [](void* vector) { delete static_cast<std::vector<double>*>(vector); });
  return py::array_t<double>(std::move(shape), owned->data(), owner);
}

py::tuple take(BoundFlight& bound) {
  const Lock lock(*bound.guarded);
  const Simulation& simulation = bound.guarded->simulation;
  LogRows rows = bound.flight.take();
  const auto terms = static_cast<py::ssize_t>(simulation.wrench_terms().size());
  const py::ssize_t with_wrenches = rows.wrenches.empty() ? 0 : rows.count;
  return py::make_tuple(array_of(std::move(rows.table), {rows.count, bound.columns}),
                        array_of(std::move(rows.wrenches), {with_wrenches, terms, 6}));
}

py::bytes csv_rows(const py::object& rows) {
  const Numbers table = numbers(rows, 2, "the table");
  const auto columns = static_cast<std::size_t>(table.shape(1));
  std::string text;
  without_gil([&] {
    for (py::ssize_t row = 0; row < table.shape(0); ++row) {
      append_csv(table.data() + row * table.shape(1), columns, text);
    }
  });
  return text;
}

}  // namespace

void bind_flight(py::module_& m) {
  py::class_<BoundFlight>(m, "Flight", "Logged run that is advanced in pieces.")
      .def(py::init(&create_flight), py::arg("simulation"), py::arg("commands"),
           py::arg("log_every"), py::arg("wrenches") = true,
           py::arg("topics") = std::vector<std::string>{}, py::arg("to_fill") = 0)
      .def("advance", &advance, py::arg("n"),
           "Simulate n steps and return their number. In a fleet, publish the command that is due "
           "and return the number of steps until the next. Raises as `Simulation.step`.")
      .def("take", &take,
           "Return the rows logged since the last call: table (rows, columns) and wrenches (rows, "
           "terms, 6). The last `to_fill` columns are NaN; wrenches are empty unless requested.");

  py::class_<Run>(m, "Run", "Context manager for the duration of a run.")
      .def(py::init<const Self&>(), py::arg("simulation"))
      .def("__enter__", &Run::begin,
           "Allow only this flight to advance the simulation from now on.")
      .def("__exit__", [](Run& run, const py::args&) { run.end(); });

  m.def(
      "fault_of_commands",
      [](const py::object& commands) -> std::optional<std::pair<Eigen::Index, std::string>> {
        const Numbers table = numbers(commands, 2, "commands");
        const auto fault = Commands::fault(
            Eigen::Map<const Commands::Table>(table.data(), table.shape(0), table.shape(1)));
        if (!fault) return std::nullopt;
        return std::pair{fault->row, fault->what};
      },
      py::arg("table"),
      "Return row and reason if a table (rows, 1 + n) is not a valid command table, else None.");
  m.def("log_columns", py::overload_cast<std::size_t>(&log_columns), py::arg("rotor_count"),
        "Return the column names of a log for a number of rotors, as in the header of a CSV file.");
  m.def(
      "flight_columns",
      [](const Self& self, const std::vector<std::string>& topics) {
        const Lock lock(*self);
        return columns(self, topics);
      },
      py::arg("simulation"), py::arg("topics"),
      "Return the column names of a flight that logs these topics.");
  m.def("log_remark", &log_remark, py::arg("ignored"),
        "Return a log's comment on ignored elements, or \"\".");
  m.def("csv_rows", &csv_rows, py::arg("table"),
        "Format the rows of a table as CSV with the fewest digits that restore every bit.");
}

}  // namespace quadcore::bindings
