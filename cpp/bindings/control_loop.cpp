#include "quadcore/control/control_loop.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "arguments.hpp"
#include "bindings.hpp"
#include "controller.hpp"
#include "flight.hpp"
#include "odometry.hpp"
#include "quadcore/commands.hpp"

namespace quadcore::bindings {
namespace {

using control::ReferencePreview;
using control::ReferenceShape;

/// A compiled function of the user, as `quadcore.CompiledController` describes it.
using CompiledFunction = void (*)(double time, double* state, double* reference, double* data,
                                  double* speeds);

/// Numbers of a state and of a reference for a compiled function: the first of their messages.
using CompiledState = std::array<double, 13>;
using CompiledReference = std::array<double, 18>;

/// A control loop with the number, the saturation and the duration of its calls.
class BoundLoop {
 public:
  BoundLoop(BoundFlight& bound, double rate, double delay, bool timed)
      : bound_(bound),
        loop_(bound.guarded->simulation, bound.flight, rate, delay),
        width_(bound.guarded->simulation.command_width()),
        timed_(timed) {
    bound.after_step = [this] { loop_.finish(); };
  }
  ~BoundLoop() { bound_.after_step = nullptr; }
  BoundLoop(const BoundLoop&) = delete;
  BoundLoop& operator=(const BoundLoop&) = delete;

  /// Advances under a built-in controller, without the interpreter. Returns the number of steps, or
  /// in a fleet the number until the next event.
  std::int64_t follow(std::int64_t n, BoundController& bound, const std::string& odometry,
                      const ReferenceShape& reference) {
    control::GuidedController& controller = bound.controller;
    const Lock lock(*bound_.guarded);
    if (&*bound.flown != &*bound_.guarded) {
      throw InputError("the controller flies another simulation. Reset it for this one.");
    }
    if (controller.rotors() != width_) check_command(nullptr, controller.rotors(), width_);
    const std::size_t topic =
        control::GuidedController::find_odometry(bound_.guarded->simulation.topics(), odometry);
    const ReferencePreview::ListTimes list_times = [this](double* times, std::size_t count) {
      loop_.list_times(times, count);
    };
    const auto call = [&](double period, double* speeds) {
      clocked([&] { controller.command(period, topic, reference, list_times, speeds); });
      saturated_ += controller.saturated();
    };
    return fly(n, call, [](const auto& advance) { without_gil(advance); });
  }

  /// Advances under a function of Python's, which may read the simulation.
  /// \param function  called without arguments; returns the speeds to command
  /// \param limits    speeds at which a rotor counts as saturated, (width_,) [rad/s]
  std::int64_t advance(std::int64_t n, const py::function& function, const py::object& limits) {
    return advance_by(n, limits, [&] { return function(); });
  }

  /// The same for a function of the time and of the latest odometry.
  /// \param vehicle  object whose function `topic` the odometry passes on
  std::int64_t control(std::int64_t n, const py::function& function, const py::object& limits,
                       const std::string& odometry, const py::object& vehicle) {
    const Simulation& simulation = bound_.guarded->simulation;
    const Topics& topics = simulation.topics();
    const std::size_t topic = control::GuidedController::find_odometry(topics, odometry);
    return advance_by(n, limits, [&] {
      BoundOdometry now{vehicle, topics[topic].stamp, topics.read<messages::Odometry>(topic), {}};
      return function(simulation.time(), std::move(now));
    });
  }

  /// Advances under a compiled function of the user, without the interpreter.
  /// \param address  of a CompiledFunction
  /// \param data     numbers that the function may change, 1-D
  std::int64_t control_compiled(std::int64_t n, std::uintptr_t address, const py::array& data,
                                const py::object& limits, const std::string& odometry,
                                const ReferenceShape& reference) {
    const auto function = reinterpret_cast<CompiledFunction>(address);
    double* const own = writable(data, {data.size()}, "data");
    const Numbers most = check_limits(limits);
    const Lock lock(*bound_.guarded);
    const Simulation& simulation = bound_.guarded->simulation;
    const Topics& topics = simulation.topics();
    const std::size_t topic = control::GuidedController::find_odometry(topics, odometry);
    const auto call = [&](double, double* speeds) {
      const double time = simulation.time();
      CompiledState state;
      CompiledReference wanted;
      std::copy_n(topics[topic].values.data(), state.size(), state.data());
      messages::write(reference.at(time), wanted.data());
      std::fill_n(speeds, width_, std::numeric_limits<double>::quiet_NaN());
      clocked([&] { function(time, state.data(), wanted.data(), own, speeds); });
      if (!std::all_of(speeds, speeds + width_, [](double w) { return std::isfinite(w); })) {
        const py::gil_scoped_acquire gil;
        take(py::array_t<double>(static_cast<py::ssize_t>(width_), speeds), speeds);
      }
      count_saturated(speeds, most);
    };
    return fly(n, call, [](const auto& advance) { without_gil(advance); });
  }

  std::int64_t calls() const { return calls_; }
  std::int64_t saturated() const { return saturated_; }
  py::array_t<double> seconds() const {
    return py::array_t<double>(static_cast<py::ssize_t>(seconds_.size()), seconds_.data());
  }
  const control::ControlLoop& loop() const { return loop_; }

 private:
  /// \param ask  called without the lock; returns the speeds to command
  template <class Ask>
  std::int64_t advance_by(std::int64_t n, const py::object& limits, const Ask& ask) {
    const Numbers most = check_limits(limits);
    const Lock lock(*bound_.guarded);
    const auto call = [&](double, double* speeds) {
      bound_.guarded->simulation.state();  // which arrays in Python view
      py::object answer;
      without_lock([&] { clocked([&] { answer = ask(); }); });
      take(answer, speeds);
      count_saturated(speeds, most);
    };
    return fly(n, call, [](const auto& advance) { advance(); });
  }

  /// Advances n steps, or prepares a step of a fleet.
  /// \param call    commands the speeds
  /// \param enclose  runs what advances, with the interpreter or without
  template <class Call, class Enclose>
  std::int64_t fly(std::int64_t n, const Call& call, const Enclose& enclose) {
    if (bound_.guarded->in_fleet) return loop_.prepare(n, call);
    raising_warnings(*bound_.guarded, [&] { enclose([&] { loop_.advance(n, call); }); });
    return n;
  }

  Numbers check_limits(const py::object& limits) const {
    Numbers most = numbers(limits, 1, "limits");
    check_shape(most, {static_cast<py::ssize_t>(width_)}, "limits");
    return most;
  }

  /// Counts a call if a speed reaches its limit.
  void count_saturated(const double* speeds, const Numbers& most) {
    bool at_limit = false;
    for (std::size_t i = 0; i < width_; ++i) {
      at_limit = at_limit || std::abs(speeds[i]) >= most.data()[i];
    }
    saturated_ += at_limit;
  }

  template <class Call>
  void clocked(const Call& call) {
    using Clock = std::chrono::steady_clock;
    ++calls_;
    if (!timed_) return call();
    const Clock::time_point begin = Clock::now();
    call();
    seconds_.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
  }

  /// Lets what is called use the simulation meanwhile.
  template <class Call>
  void without_lock(const Call& call) {
    std::atomic<bool>& busy = bound_.guarded->busy;
    busy = false;
    try {
      call();
    } catch (...) {
      busy = true;
      throw;
    }
    if (busy.exchange(true)) refuse_another_thread();
  }

  /// Copies the speeds that a controller returned.
  void take(const py::object& answer, double* speeds) const {
    if (take_floats(answer, speeds)) return;
    try {
      const Numbers array = numbers(answer, 1, "command");
      check_command(array.data(), static_cast<std::size_t>(array.size()), width_);
      std::copy_n(array.data(), width_, speeds);
    } catch (const InputError& error) {
      const double time = bound_.guarded->simulation.time();
      const std::string what = error.what();
      const auto shorten = py::module_::import("quadcore.support.arguments").attr("shorten");
      throw FlightError(time, "the flight failed at t = " + std::to_string(time) +
                                  " s: the controller returned " +
                                  shorten(answer).cast<std::string>() + ": " +
                                  what.substr(0, what.find(". Give")) + ". Return " +
                                  std::to_string(width_) + " rotor speeds in rad/s.");
    }
  }

  /// Copies the usual lists of floats without NumPy. Returns false for everything else.
  bool take_floats(const py::object& answer, double* speeds) const {
    if (!PyList_CheckExact(answer.ptr())) return false;
    const py::list list = py::reinterpret_borrow<py::list>(answer);
    if (list.size() != width_) return false;
    for (std::size_t i = 0; i < width_; ++i) {
      PyObject* const number = list[i].ptr();
      if (!PyFloat_CheckExact(number) || !std::isfinite(PyFloat_AS_DOUBLE(number))) return false;
      speeds[i] = PyFloat_AS_DOUBLE(number);
    }
    return true;
  }

  BoundFlight& bound_;
  control::ControlLoop loop_;
  std::size_t width_;
  bool timed_;
  std::int64_t calls_ = 0, saturated_ = 0;
  std::vector<double> seconds_;
};

py::array_t<double> copy_array(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

}  // namespace

void bind_control_loop(py::module_& m) {
  py::class_<BoundLoop>(m, "ControlLoop", "Calls a controller at its rate while a flight advances.")
      .def(py::init<BoundFlight&, double, double, bool>(), py::arg("flight"), py::arg("rate"),
           py::arg("delay"), py::arg("timed") = false, py::keep_alive<1, 2>())
      .def("follow", &BoundLoop::follow, py::arg("n"), py::arg("controller"), py::arg("odometry"),
           py::arg("reference"), "Advance n steps under a built-in controller.")
      .def("advance", &BoundLoop::advance, py::arg("n"), py::arg("function"), py::arg("limits"),
           "Advance n steps under a function that returns rotor speeds (n,), rad/s.")
      .def("control", &BoundLoop::control, py::arg("n"), py::arg("function"), py::arg("limits"),
           py::arg("odometry"), py::arg("vehicle"),
           "Advance n steps under a function of time, s, and odometry that returns rotor speeds "
           "(n,), rad/s.")
      .def("control_compiled", &BoundLoop::control_compiled, py::arg("n"), py::arg("address"),
           py::arg("data"), py::arg("limits"), py::arg("odometry"), py::arg("reference"),
           "Advance n steps under a compiled function at an address, see CompiledController.")
      .def_property_readonly("calls", &BoundLoop::calls, "How often the controller was called.")
      .def_property_readonly("saturated", &BoundLoop::saturated,
                             "Number of calls with a command that the rotors could not follow.")
      .def_property_readonly(
          "rate_variation",
          [](const BoundLoop& loop) { return copy_array(loop.loop().rate_variation()); },
          "Total variation of the magnitude of each joint rate (rotors,), rad/s.")
      .def_property_readonly(
          "command_variation",
          [](const BoundLoop& loop) { return copy_array(loop.loop().command_variation()); },
          "Total variation of the magnitude of each command (n,), rad/s.")
      .def_property_readonly("seconds", &BoundLoop::seconds,
                             "Duration of each call, s; empty unless timed.");
}

}  // namespace quadcore::bindings
