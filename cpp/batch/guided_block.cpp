#include "guided_block.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "quadcore/control/control_loop.hpp"
#include "quadcore/control/guided_controller.hpp"

namespace quadcore::batch {
namespace {

/// Make a call of a controller, and note its duration and whether the rotors were saturated.
template <class Call>
void count_call(BatchGuided& guided, const Call& call) {
  using Clock = std::chrono::steady_clock;
  constexpr std::int64_t between_timings = 16;
  const bool is_timed = guided.calls++ % between_timings == 0;
  const Clock::time_point begin = is_timed ? Clock::now() : Clock::time_point();
  guided.saturated += call();
  if (!is_timed) return;
  guided.seconds.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
}

}  // namespace

/// A follower and the memory of its controller.
struct GuidedBlock::Control {
  Follower* follower;
  control::Schedule schedule;
  control::ReferencePreview* preview;
  std::vector<double> pending, memory;  ///< states of the schedule and of the controller
};

GuidedBlock::Control GuidedBlock::take_control(Follower& follower) {
  const BatchGuide& guide = *follower.guide;
  Control control{
      &follower, {guide.rate, guide.delay, guide.controller->rotors()}, nullptr, {}, {}};
  control.preview = &preview_of(control);
  control.pending.resize(control.schedule.state_size());
  control.memory.resize(guide.controller->state_size());
  return control;
}

control::ReferencePreview& GuidedBlock::preview_of(const Control& control) {
  const BatchGuide& guide = *control.follower->guide;
  for (const Shared& shared : previews_) {
    const BatchGuide& other = *shared.guide;
    if (other.controller == guide.controller && other.reference == guide.reference &&
        other.rate == guide.rate) {
      return *shared.preview;
    }
  }
  previews_.push_back({&guide, std::make_unique<control::ReferencePreview>(*guide.controller)});
  return *previews_.back().preview;
}

void GuidedBlock::advance(std::vector<Follower>& followers, std::int64_t n,
                          std::int64_t log_every) {
  std::vector<Control> controls;
  for (Follower& follower : followers) controls.push_back(take_control(follower));
  std::int64_t step = 0;
  lanes_.show(block_, work_);
  for (Follower& follower : followers) {
    log(follower, 0);
    note_rates(follower);
  }
  while (step < n) {
    std::int64_t next = std::min(n, (step / log_every + 1) * log_every);
    for (Control& control : controls) {
      if (control.follower->has_left) continue;
      const auto now = static_cast<double>(step);
      update(control, now);
      const double event = control.schedule.next_event(now, dt_, control.pending.data());
      if (event < static_cast<double>(next)) next = static_cast<std::int64_t>(event);
    }
    for (; step < next; ++step) this->step(followers);
    if (step % log_every != 0) continue;
    for (const Follower& follower : followers) {
      if (!follower.has_left) log(follower, static_cast<double>(step));
    }
  }
  for (const Follower& follower : followers) {
    follower.guided->rate_variation = follower.rates.sums();
    follower.guided->command_variation = follower.commands.sums();
  }
}

void GuidedBlock::step(std::vector<Follower>& followers) {
  std::int64_t flown[widest_lanes];
  lanes_.step(block_, 1, dt_, work_, flown);
  lanes_.show(block_, work_);
  for (Follower& follower : followers) {
    if (flown[follower.vehicle % widest_lanes] == 0) {
      drop(follower);
    } else {
      note_rates(follower);
    }
  }
}

void GuidedBlock::note_rates(Follower& follower) const {
  double rates[most_rotors];
  for (std::size_t i = 0; i < lanes_.rotors(); ++i) {
    rates[i] = shown(StateRow::joint(StateRow::joint_rate, i), follower);
  }
  follower.rates.add(rates);
}

void GuidedBlock::drop(Follower& follower) {
  follower.has_left = true;
  lanes_.let_fly(follower.vehicle, false);
}

void GuidedBlock::update(Control& control, double step) {
  Follower& follower = *control.follower;
  try {
    const double* const speeds = control.schedule.update(
        step, dt_, control.pending.data(),
        [&](double period, double* asked) { command(control, step, period, asked); });
    if (!speeds) return;
    const std::size_t rotors = follower.guide->controller->rotors();
    follower.speeds.assign(speeds, speeds + rotors);
    const bool are_finite =
        std::all_of(speeds, speeds + rotors, [](double speed) { return std::isfinite(speed); });
    if (!are_finite) return drop(follower);
    lanes_.command(follower.vehicle, speeds);
    follower.commands.add(speeds);
  } catch (const std::exception&) {  // outside the lanes, the error ends the flight
    drop(follower);
  }
}

void GuidedBlock::command(Control& control, double step, double period, double* speeds) {
  const Follower& follower = *control.follower;
  count_call(*follower.guided, [&] {
    const OdometryErrors& errors = *follower.errors;
    const messages::Odometry odometry =
        measure(work_ + follower.vehicle % widest_lanes, errors, follower.seed,
                follower.draws + step * errors.draws());
    const control::ReferencePreview::Point& point = control.preview->at(
        step * dt_, *follower.guide->reference, [&](double* times, std::size_t count) {
          double at = step;
          for (std::size_t i = 0; i < count; ++i) {
            times[i] = at * dt_;
            at = control.schedule.next_call(at, dt_);
          }
        });
    follower.guide->controller->command(period, odometry, point.wanted, control.memory.data(),
                                        speeds, point.flat ? &*point.flat : nullptr);
    return control::Controller::saturated(control.memory.data());
  });
}

messages::Odometry measure(const double* shown, const OdometryErrors& errors, std::uint64_t seed,
                           double draws) {
  messages::Odometry odometry;
  const auto get = [&](std::size_t row, auto&& numbers) {
    for (Eigen::Index i = 0; i < numbers.size(); ++i) {
      numbers[i] = shown[(row + static_cast<std::size_t>(i)) * widest_lanes];
    }
  };
  get(StateRow::position, odometry.position);
  get(StateRow::orientation, odometry.orientation.coeffs());
  get(StateRow::velocity, odometry.linear_velocity);
  get(StateRow::rate, odometry.angular_velocity);
  if (errors.is_none()) return odometry;
  double biases[OdometryErrors::biases] = {};
  errors.apply(odometry, 0, seed, draws, biases);
  return odometry;
}

void GuidedBlock::log(const Follower& follower, double step) const {
  double* row = follower.guided->log;
  if (!row) return;
  row += static_cast<std::size_t>(follower.guided->rows) * (1 + StateRow::joints + lanes_.rotors());
  *row++ = step * dt_;
  for (std::size_t i = 0; i < StateRow::joints; ++i) *row++ = shown(i, follower);
  for (std::size_t i = 0; i < lanes_.rotors(); ++i) {
    *row++ = shown(StateRow::joint(StateRow::joint_rate, i), follower);
  }
  ++follower.guided->rows;
}

void follow_apart(Simulation& simulation, const BatchGuide& guide, const std::string& odometry,
                  std::int64_t n, std::int64_t log_every, BatchGuided& guided) {
  const std::size_t topic = control::GuidedController::find_odometry(simulation.topics(), odometry);
  control::GuidedController controller(simulation, *guide.controller,
                                       simulation.describe_vehicle());
  Flight flight(simulation, {}, guided.log ? log_every : std::numeric_limits<std::int64_t>::max(),
                false);
  control::ControlLoop loop(simulation, flight, guide.rate, guide.delay);
  const control::ReferencePreview::ListTimes list_times =
      [&loop](double* times, std::size_t count) { loop.list_times(times, count); };
  const auto finish = [&] {
    guided.rate_variation = loop.rate_variation();
    guided.command_variation = loop.command_variation();
    const LogRows rows = flight.take();
    if (!guided.log) return;
    std::copy(rows.table.begin(), rows.table.end(), guided.log);
    guided.rows = rows.count;
  };
  try {
    loop.advance(n, [&](double period, double* speeds) {
      count_call(guided, [&] {
        controller.command(period, topic, *guide.reference, list_times, speeds);
        return controller.saturated();
      });
    });
  } catch (...) {
    finish();
    throw;
  }
  finish();
}

}  // namespace quadcore::batch
