#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "built.hpp"
#include "older_pybind11.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/simulation.hpp"

/// \file
/// Protection of simulations against simultaneous use by Python threads.

namespace quadcore::bindings {

namespace py = pybind11;

/// A simulation that rejects simultaneous use by two Python threads, because the GIL is released
/// during steps. Callbacks of a run, such as controllers, may not advance it either.
struct Guarded {
  Simulation simulation;
  std::atomic<bool> busy{false};
  bool in_fleet = false;                  ///< whether only a fleet advances it
  std::optional<unsigned long> flown_by;  ///< thread of the present run; protected by the GIL
  /// Python exception, such as KeyboardInterrupt, that ended a motion without a failure of it.
  std::exception_ptr interrupt;

  Guarded(const Model& model, const World& world, const SimulationOptions& options)
      : simulation(model, world, options) {}
};

[[noreturn]] inline void refuse_another_thread() {
  throw InputError(
      "this simulation is in use by another thread. Use a separate simulation for each thread.");
}

/// Throw InputError within a run, because only the run may use the function `call`.
inline void refuse_in_flight(const Guarded& guarded, const char* call) {
  if (!guarded.flown_by) return;
  if (*guarded.flown_by != PyThread_get_thread_ident()) refuse_another_thread();
  throw InputError(
      std::string(call) +
      ": this simulation is running, and callbacks may only read it and publish. Return the "
      "command from the callback, and use a separate simulation for predictions.");
}

/// Throw InputError for a function that a vehicle of a fleet does not have.
inline void refuse_in_fleet(const Guarded& guarded, const char* call) {
  if (!guarded.in_fleet) return;
  throw InputError(std::string(call) + ": this vehicle belongs to a fleet. Use Fleet." + call +
                   ", which acts on all vehicles.");
}

class Lock {
 public:
  explicit Lock(Guarded& guarded) : guarded_(guarded) {
    if (guarded.busy.exchange(true)) refuse_another_thread();
  }
  /// Lock for functions that only the run may use during a run.
  Lock(Guarded& guarded, const char* call) : Lock(not_in_flight(guarded, call)) {}
  ~Lock() { guarded_.busy = false; }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  static Guarded& not_in_flight(Guarded& guarded, const char* call) {
    refuse_in_flight(guarded, call);
    return guarded;
  }

  Guarded& guarded_;
};

/// Call `function` without the GIL. pybind11's guard is not suitable: the interpreter may have
/// ended when a daemon thread returns, and Python then unwinds the thread, which no destructor
/// survives.
template <class Function>
void without_gil(const Function& function) {
  PyThreadState* const thread = PyEval_SaveThread();
  std::exception_ptr thrown;
  try {
    function();
  } catch (...) {
    thrown = std::current_exception();
  }
  PyEval_RestoreThread(thread);
  if (thrown) std::rethrow_exception(thrown);
}

/// Issue the simulation's warnings of a call as Python warnings and update the state, which arrays
/// in Python view, even if the call fails. If an interrupt ended the call, raise it instead of the
/// failure.
template <class Call>
void raising_warnings(Guarded& guarded, const Call& call) {
  const Simulation& simulation = guarded.simulation;
  const std::size_t before = simulation.warnings().size();
  const auto finish = [&] {
    simulation.state();
    for (std::size_t i = before; i < simulation.warnings().size(); ++i) {
      // Raises if the user has turned the warning into an error.
      py::module_::import("quadcore.support.warning").attr("warn")(simulation.warnings()[i]);
    }
  };
  try {
    call();
  } catch (...) {
    const std::exception_ptr interrupt = std::exchange(guarded.interrupt, nullptr);
    finish();
    if (interrupt) std::rethrow_exception(interrupt);
    throw;
  }
  finish();
}

/// The simulation of a bound function.
struct Self {
  std::shared_ptr<Guarded> guarded;

  Guarded& operator*() const { return *guarded; }
  Simulation* operator->() const { return &guarded->simulation; }
};

}  // namespace quadcore::bindings

namespace pybind11::detail {

template <>
struct type_caster<quadcore::bindings::Self> {
  PYBIND11_TYPE_CASTER(quadcore::bindings::Self, const_name("quadcore._core.Simulation"));

  bool load(handle source, bool convert) {
    return quadcore::bindings::load_built(source, convert, value.guarded);
  }
};

}  // namespace pybind11::detail
