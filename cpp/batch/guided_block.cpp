#include "guided_block.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "flat_table.hpp"
#include "quadcore/control/control_loop.hpp"
#include "quadcore/control/guided_controller.hpp"

namespace quadcore::batch {
/// A follower and the memory of its controller.
struct GuidedBlock::Control {
  Follower* follower;
  control::Schedule schedule;
  control::ReferencePreview* preview;
  std::vector<double> pending, memory;  ///< states of the schedule and of the controller
};

GuidedBlock::GuidedBlock(LaneBlocks& lanes, std::size_t block, double dt, double* work)
    : lanes_(lanes),
      block_(block),
      dt_(dt),
      work_(work),
      rates_(lanes.rotors(), TotalVariation(widest_lanes)) {}
GuidedBlock::~GuidedBlock() = default;

void GuidedBlock::add(Follower& follower) {
  const BatchGuide& guide = *follower.guide;
  control::ReferencePreview& preview = preview_of(guide);
  const auto controller = guide.controller->in_lanes(std::max(1 / guide.rate, dt_));
  if (!controller) {
    const control::Schedule schedule(guide.rate, guide.delay, guide.controller->rotors());
    alone_.push_back({&follower, schedule, &preview, std::vector<double>(schedule.state_size()),
                      std::vector<double>(guide.controller->state_size())});
    return;
  }
  const auto takes = [&](const LaneControls& group) { return group.takes(follower, *controller); };
  auto group = std::find_if(in_lanes_.begin(), in_lanes_.end(), takes);
  if (group == in_lanes_.end()) {
    in_lanes_.emplace_back(follower, controller);
    group = in_lanes_.end() - 1;
  }
  group->add(follower, *controller, preview);
}

control::ReferencePreview& GuidedBlock::preview_of(const BatchGuide& guide) {
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
  for (Follower& follower : followers) add(follower);
  std::int64_t step = 0;
  lanes_.show(block_, work_);
  for (const Follower& follower : followers) log(follower, 0);
  note_rates();
  while (step < n) {
    const auto logged = static_cast<double>(std::min(n, (step / log_every + 1) * log_every));
    const auto next = static_cast<std::int64_t>(update(static_cast<double>(step), logged));
    for (; step < next; ++step) this->step(followers);
    if (!lanes_.are_hinged()) lanes_.show(block_, work_);
    if (step % log_every != 0) continue;
    for (const Follower& follower : followers) {
      if (!follower.has_left) log(follower, static_cast<double>(step));
    }
  }
  for (const Follower& follower : followers) {
    for (const TotalVariation& rates : rates_) {
      follower.guided->rate_variation.push_back(rates.sums()[follower.lane()]);
    }
    follower.guided->command_variation = follower.commands.sums();
  }
}

/// Call the controllers that are due. Returns the next step at which one is due or a command takes
/// effect, or `next` if that is earlier.
double GuidedBlock::update(double step, double next) {
  for (LaneControls& group : in_lanes_) {
    group.update(
        step, dt_, work_, [this](Follower& follower) { drop(follower); },
        [this](Follower& follower, const double* speeds) { take(follower, speeds); });
    next = std::min(next, group.next_event(step, dt_));
  }
  for (Control& control : alone_) {
    if (control.follower->has_left) continue;
    update(control, step);
    next = std::min(next, control.schedule.next_event(step, dt_, control.pending.data()));
  }
  return next;
}

void GuidedBlock::step(std::vector<Follower>& followers) {
  std::int64_t flown[widest_lanes];
  lanes_.step(block_, 1, dt_, work_, flown);
  for (Follower& follower : followers) {
    if (flown[follower.lane()] == 0) drop(follower);
  }
  note_rates();
}

void GuidedBlock::note_rates() {
  const double* const rows = lanes_.find_rates(block_, work_);
  for (std::size_t i = 0; i < rates_.size(); ++i) {
    rates_[i].add(rows + StateRow::joint(StateRow::joint_rate, i) * widest_lanes);
  }
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
    take(follower, speeds);
  } catch (const std::exception&) {  // outside the lanes, the error ends the flight
    drop(follower);
  }
}

/// Command the rotors of a follower.
void GuidedBlock::take(Follower& follower, const double* speeds) {
  const std::size_t rotors = follower.guide->controller->rotors();
  follower.speeds.assign(speeds, speeds + rotors);
  const bool are_finite =
      std::all_of(speeds, speeds + rotors, [](double speed) { return std::isfinite(speed); });
  if (!are_finite) return drop(follower);
  lanes_.command(follower.vehicle, speeds);
  follower.commands.add(speeds);
}

void GuidedBlock::command(Control& control, double step, double period, double* speeds) {
  const Follower& follower = *control.follower;
  const bool is_timed = count_call(*follower.guided);
  const Stopwatch stopwatch;
  const OdometryErrors& errors = *follower.errors;
  const messages::Odometry odometry = measure(work_ + follower.lane(), errors, follower.seed,
                                              follower.draws + step * errors.draws());
  const control::ReferencePreview::Point& point = control.preview->at(
      step * dt_, *follower.guide->reference, [&](double* times, std::size_t count) {
        double at = step;
        for (std::size_t i = 0; i < count; ++i) {
          times[i] = at * dt_;
          at = control.schedule.next_call(at, dt_);
        }
      });
  double* const memory = control.memory.data();
  const std::optional<control::FlatState> flat = point.flat_state();
  follower.guide->controller->command(period, odometry, point.wanted, memory, speeds,
                                      flat ? &*flat : nullptr);
  follower.guided->saturated += control::Controller::saturated(memory);
  if (is_timed) follower.guided->seconds.push_back(stopwatch.seconds());
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
      const bool is_timed = count_call(guided);
      const Stopwatch stopwatch;
      controller.command(period, topic, *guide.reference, list_times, speeds);
      guided.saturated += controller.saturated();
      if (is_timed) guided.seconds.push_back(stopwatch.seconds());
    });
  } catch (...) {
    finish();
    throw;
  }
  finish();
}

}  // namespace quadcore::batch
