#include "quadcore/fleet.hpp"

#include <pybind11/stl.h>

#include <list>

#include "bindings.hpp"
#include "flight.hpp"

namespace quadcore::bindings {
namespace {

using Members = std::vector<std::shared_ptr<Guarded>>;

std::vector<Simulation*> simulations_of(const Members& members) {
  std::vector<Simulation*> simulations;
  for (const auto& member : members) simulations.push_back(&member->simulation);
  return simulations;
}

/// A fleet and the simulations that it advances.
struct BoundFleet {
  Members members;
  Fleet fleet;

  BoundFleet(Members given, std::vector<std::string> names)
      : members(std::move(given)), fleet(simulations_of(members), std::move(names)) {
    for (const auto& member : members) member->in_fleet = true;
  }
};

/// A lock of all members; see Lock.
class FleetLock {
 public:
  template <class... Call>
  explicit FleetLock(const BoundFleet& bound, Call... call) {
    for (const auto& member : bound.members) locks_.emplace_back(*member, call...);
  }

 private:
  std::list<Lock> locks_;
};

std::unique_ptr<BoundFleet> create_fleet(const std::vector<Self>& vehicles,
                                         std::vector<std::string> names) {
  Members members;
  for (const Self& self : vehicles) {
    for (const auto& member : members) {
      if (member == self.guarded) {
        throw InputError("the same simulation twice. Make a simulation for each vehicle.");
      }
    }
    members.push_back(self.guarded);
  }
  for (const auto& member : members) const Lock lock(*member, "Fleet()");
  return std::make_unique<BoundFleet>(std::move(members), std::move(names));
}

/// Call a function and issue the warnings of all vehicles.
template <class Act>
void raising_all_warnings(const BoundFleet& bound, std::size_t i, const Act& act) {
  if (i == bound.members.size()) return act();
  raising_warnings(*bound.members[i], [&] { raising_all_warnings(bound, i + 1, act); });
}

/// Advance by n steps.
/// \param flights  those of the vehicles, which log after each step
void advance_fleet(BoundFleet& bound, std::int64_t n, const std::vector<BoundFlight*>& flights) {
  raising_all_warnings(bound, 0, [&] {
    without_gil([&] {
      for (; n > 0; --n) {
        bound.fleet.step();
        for (BoundFlight* const flight : flights) {
          if (flight->after_step) flight->after_step();
          flight->flight.finish(1);
        }
      }
    });
  });
}

/// Steps between checks for signals.
constexpr std::int64_t fleet_steps_between_signals = 1000;

void step_fleet(BoundFleet& bound, std::int64_t n) {
  if (n < 0) {
    throw InputError("the step count is " + std::to_string(n) + ". Give a whole number >= 0.");
  }
  const FleetLock lock(bound, "step()");
  while (n > 0) {
    const std::int64_t steps = std::min(n, fleet_steps_between_signals);
    advance_fleet(bound, steps, {});
    n -= steps;
    if (n > 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
}

}  // namespace

void bind_fleet(py::module_& m) {
  py::class_<FleetSnapshot>(m, "FleetSnapshot", "Complete state of a fleet, for `Fleet.restore`.")
      .def_property_readonly(
          "vehicles", [](const FleetSnapshot& snapshot) { return snapshot.vehicles; },
          "Snapshot of each vehicle, list of Snapshot.");

  py::class_<BoundFleet>(m, "Fleet", py::dynamic_attr(),
                         "Several vehicles in one world; use quadcore.Fleet.")
      .def(py::init(&create_fleet), py::arg("vehicles"), py::arg("names"))
      .def("step", &step_fleet, py::arg("n") = 1, R"(Advance all vehicles by whole steps of `dt`.

Parameters
----------
n : int
    Number of steps.

Raises
------
FlightError
    If a flight fails, with `time`, vehicle and reason; restore and reset go on from there.)")
      .def(
          "_advance",
          [](BoundFleet& bound, std::int64_t n, const std::vector<BoundFlight*>& flights) {
            const FleetLock lock(bound);
            advance_fleet(bound, n, flights);
          },
          py::arg("n"), py::arg("flights"))
      .def(
          "snapshot",
          [](const BoundFleet& bound) {
            const FleetLock lock(bound);
            return bound.fleet.snapshot();
          },
          R"(Save all that the future depends on.

Returns
-------
FleetSnapshot
    For `restore`.)")
      .def(
          "restore",
          [](BoundFleet& bound, const FleetSnapshot& snapshot) {
            const FleetLock lock(bound, "restore()");
            bound.fleet.restore(snapshot);
          },
          py::arg("snapshot"), R"(Restore a snapshot of this fleet, bit-identically.

Parameters
----------
snapshot : FleetSnapshot
    Result of `snapshot`.

Raises
------
InputError
    If the snapshot belongs to another fleet.)")
      .def(
          "reset",
          [](BoundFleet& bound) {
            const FleetLock lock(bound, "reset()");
            bound.fleet.reset();
          },
          "Return to the initial state, each vehicle with its present seed, bit-identically.")
      .def_property_readonly(
          "time", [](const BoundFleet& bound) { return bound.members.front()->simulation.time(); },
          "Simulation time, s.")
      .def_property_readonly(
          "dt", [](const BoundFleet& bound) { return bound.members.front()->simulation.dt(); },
          "Time step, s.")
      .def_property_readonly(
          "names", [](const BoundFleet& bound) { return bound.fleet.names(); },
          "Name of each vehicle, list of str.")
      .def_property_readonly(
          "warnings",
          [](const BoundFleet& bound) {
            const FleetLock lock(bound);
            return bound.fleet.warnings();
          },
          "Warnings about the vehicles together, list of str.")
      .def_property_readonly(
          "free_bodies",
          [](const BoundFleet& bound) {
            const FleetLock lock(bound);
            return bound.fleet.free_bodies();
          },
          "Present motion of the world's free bodies, list of FreeBodyState.");
}

}  // namespace quadcore::bindings
