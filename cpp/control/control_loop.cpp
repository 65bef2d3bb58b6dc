#include "quadcore/control/control_loop.hpp"

namespace quadcore::control {

ControlLoop::ControlLoop(Simulation& simulation, Flight& flight, double rate, double delay)
    : simulation_(simulation),
      flight_(flight),
      width_(simulation.command_width()),
      schedule_(rate, delay, width_),
      state_(schedule_.state_size()) {
  rates_.add(simulation.state().rotor_velocity.array().abs());
}

void ControlLoop::advance(std::int64_t n, const Call& call) {
  for (; n > 0; --n, ++step_) {
    const double* const speeds = schedule_.update(step_, simulation_.dt(), state_.data(), call);
    if (speeds) {
      simulation_.command(speeds, width_);
      const auto width = static_cast<Eigen::Index>(width_);
      commands_.add(Eigen::Map<const Eigen::ArrayXd>(speeds, width).abs());
    }
    flight_.advance(1);
    rates_.add(simulation_.state().rotor_velocity.array().abs());
  }
}

}  // namespace quadcore::control
