#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "built.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/simulation.hpp"
#include "unpickled.hpp"

namespace quadcore::bindings {
namespace {

/// Version of the pickle format of snapshots, which may differ in another quadcore.
constexpr int snapshot_version = 1;

using Row = py::array_t<double, py::array::c_style | py::array::forcecast>;

Row row(const double* data, std::size_t size) { return Row(static_cast<py::ssize_t>(size), data); }

std::vector<double> numbers_of(const py::handle& object) {
  const auto array = py::cast<Row>(object);
  return {array.data(), array.data() + array.size()};
}

py::dict fingerprint_of(const Fingerprint& fingerprint) {
  py::dict parts;
  for (const FingerprintPart& part : fingerprint_parts()) {
    py::list facts;
    for (const Fact& fact : fingerprint.*part.facts) {
      facts.append(py::make_tuple(fact.what, fact.numbers, fact.text));
    }
    parts[part.name] = facts;
  }
  return parts;
}

py::object saved(const Built<Snapshot>& held) {
  const Snapshot& snapshot = *held;
  py::list messages;
  for (const Message& m : snapshot.messages) {
    messages.append(py::make_tuple(row(m.values.data(), m.values.size()), m.stamp, m.count));
  }
  py::dict state;
  state["version"] = snapshot_version;
  state["taken_from"] = fingerprint_of(*snapshot.taken_from);
  state["start_time"] = snapshot.start_time;
  state["steps"] = snapshot.steps;
  state["seed"] = snapshot.seed;
  state["engine"] = row(snapshot.engine.data(), snapshot.engine.size());
  state["plugins"] =
      row(snapshot.plugin_state.data(), static_cast<std::size_t>(snapshot.plugin_state.size()));
  state["messages"] = messages;
  state["warnings"] = snapshot.warnings;
  state["failure"] = snapshot.failure;
  return state;
}

std::shared_ptr<Snapshot> read(const py::object& state) {
  if (py::cast<int>(state["version"]) != snapshot_version) throw OtherVersion();
  auto fingerprint = std::make_shared<Fingerprint>();
  for (const FingerprintPart& part : fingerprint_parts()) {
    Facts& facts = (*fingerprint).*part.facts;
    for (const py::handle& held : state["taken_from"][part.name]) {
      const auto fact = py::cast<py::tuple>(held);
      facts.push_back({py::cast<std::string>(fact[0]), py::cast<std::vector<double>>(fact[1]),
                       py::cast<std::string>(fact[2])});
    }
  }
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->taken_from = fingerprint;
  snapshot->start_time = py::cast<double>(state["start_time"]);
  snapshot->steps = py::cast<std::int64_t>(state["steps"]);
  snapshot->seed = py::cast<std::uint64_t>(state["seed"]);
  snapshot->engine = numbers_of(state["engine"]);
  const std::vector<double> plugins = numbers_of(state["plugins"]);
  snapshot->plugin_state =
      Eigen::Map<const VectorXd>(plugins.data(), static_cast<Eigen::Index>(plugins.size()));
  for (const py::handle& held : state["messages"]) {
    const auto message = py::cast<py::tuple>(held);
    snapshot->messages.push_back(
        {numbers_of(message[0]), py::cast<double>(message[1]), py::cast<double>(message[2])});
  }
  snapshot->warnings = py::cast<std::vector<std::string>>(state["warnings"]);
  snapshot->failure = py::cast<std::string>(state["failure"]);
  return snapshot;
}

std::shared_ptr<Snapshot> restored(const py::object& state) {
  return unpickled("the snapshot", "Take", [&state] { return read(state); });
}

}  // namespace

void bind_snapshot(py::module_& m) {
  py::class_<Snapshot, std::shared_ptr<Snapshot>>(
      m, "Snapshot",
      "Complete state of a simulation. Its pickle contains numbers and texts but no paths.")
      .def("__repr__",
           [](const Built<Snapshot>& held) {
             return py::str("<Snapshot, {} steps from t = {:g} s>")
                 .format(held->steps, held->start_time);
           })
      .def(py::pickle(&saved, &restored));
}

}  // namespace quadcore::bindings
