#include "quadcore/control/control_loop.hpp"

#include <algorithm>

namespace quadcore::control {

ControlLoop::ControlLoop(Simulation& simulation, Flight& flight, double rate, double delay)
    : simulation_(simulation),
      flight_(flight),
      width_(simulation.command_width()),
      schedule_(rate, delay, width_),
      state_(schedule_.state_size()),
      rates_(simulation.rotor_count()),
      commands_(width_) {
  rates_.add(simulation.state().rotor_velocity.data());
}

void ControlLoop::advance(std::int64_t n, const Call& call) {
  flight_.make_room(n);
  while (n > 0) {
    const std::int64_t steps = prepare(n, call);
    flight_.advance(steps, &rates_);
    step_ += static_cast<double>(steps);
    n -= steps;
  }
}

std::int64_t ControlLoop::prepare(std::int64_t n, const Call& call) {
  const double dt = simulation_.dt();
  const double* const speeds = schedule_.update(step_, dt, state_.data(), call);
  if (speeds) {
    simulation_.command(speeds, width_);
    commands_.add(speeds);
  }
  const double event = schedule_.next_event(step_, dt, state_.data());
  return static_cast<std::int64_t>(std::min(static_cast<double>(n), event - step_));
}

void ControlLoop::finish() {
  ++step_;
  rates_.add(simulation_.state().rotor_velocity.data());
}

void ControlLoop::list_times(double* times, std::size_t count) const {
  schedule_.list_calls(step_, simulation_.dt(), times, count);
  std::transform(times, times + count, times,
                 [this](double step) { return simulation_.time_after(step - step_); });
}

}  // namespace quadcore::control
