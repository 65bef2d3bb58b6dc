#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <string>

#include "built.hpp"
#include "older_pybind11.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/simulation.hpp"

/// \file
/// What keeps Python's threads apart.

namespace quadcore::bindings {

namespace py = pybind11;

/// A simulation that refuses to be used by two Python threads at once: the GIL does not guard it
/// while it steps. Nor may what a run calls back, such as a controller, move what is being flown.
struct Guarded {
  Simulation simulation;
  std::atomic<bool> busy{false};
  std::optional<unsigned long> flown_by;  ///< the thread that is within a run; by the GIL

  Guarded(const Model& model, const World& world, const SimulationOptions& options)
      : simulation(model, world, options) {}
};

[[noreturn]] inline void refuse_another_thread() {
  throw InputError("this simulation is being used by another thread; give each its own");
}

/// Throws InputError within a run: `call` is what was called, and is the run's alone.
inline void refuse_in_flight(const Guarded& guarded, const char* call) {
  if (!guarded.flown_by) return;
  if (*guarded.flown_by != PyThread_get_thread_ident()) refuse_another_thread();
  throw InputError(std::string(call) +
                   ": a run is flying this simulation, and what it calls back may only read it and "
                   "publish; return the command, and try things out on a simulation of its own");
}

class Lock {
 public:
  explicit Lock(Guarded& guarded) : guarded_(guarded) {
    if (guarded.busy.exchange(true)) refuse_another_thread();
  }
  /// To do what is the run's alone while one flies.
  Lock(Guarded& guarded, const char* call) : Lock((refuse_in_flight(guarded, call), guarded)) {}
  ~Lock() { guarded_.busy = false; }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  Guarded& guarded_;
};

/// Calls `function` without the GIL. Not by pybind11's guard: a daemon thread may find the
/// interpreter gone when it comes back, Python then unwinds it, and no destructor survives that.
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

/// Raises in Python, as warnings, what a simulation warns of during a call, also where that fails.
template <class Call>
void raising_warnings(const Guarded& guarded, const Call& call) {
  const Simulation& simulation = guarded.simulation;
  const std::size_t before = simulation.warnings().size();
  const auto raise = [&] {
    for (std::size_t i = before; i < simulation.warnings().size(); ++i) {
      // Raises where the user has made an error of it.
      py::module_::import("quadcore.support.warning").attr("warn")(simulation.warnings()[i]);
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

/// The simulation that a bound function is called on.
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
