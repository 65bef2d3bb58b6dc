#include "guided_block.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "finally.hpp"
#include "flat_table.hpp"
#include "laws/variation.hpp"
#include "quadcore/control/control_loop.hpp"
#include "quadcore/control/guided_controller.hpp"
#include "quadcore/total_variation.hpp"

namespace quadcore::batch {
namespace {

/// Number of steps between polls, which take a block of vehicles some milliseconds.
constexpr std::int64_t steps_between_polls = 1000;

}  // namespace

/// A follower and the memory of its controller.
struct GuidedBlock::Control {
  Follower* follower;
  control::Schedule schedule;
  control::ReferencePreview* preview;
  std::vector<double> pending, memory;  ///< states of the schedule and of the controller
  TotalVariation commands;
};

GuidedBlock::GuidedBlock(LaneBlocks& lanes, std::size_t block, double dt, double* work)
    : lanes_(lanes),
      block_(block),
      dt_(dt),
      work_(work),
      rates_(lanes.rotors() * laws::VariationRow::count * widest_lanes) {}
GuidedBlock::~GuidedBlock() = default;

void GuidedBlock::add(Follower& follower) {
  const BatchGuide& guide = *follower.guide;
  control::ReferencePreview& preview = preview_of(guide);
  const auto controller = guide.controller->in_lanes(std::max(1 / guide.rate, dt_));
  if (!controller) {
    const std::size_t rotors = guide.controller->rotors();
    const control::Schedule schedule(guide.rate, guide.delay, rotors);
    alone_.push_back({&follower, schedule, &preview, std::vector<double>(schedule.state_size()),
                      std::vector<double>(guide.controller->state_size()), TotalVariation(rotors)});
    return;
  }
  const auto takes = [&](const LaneControls& group) { return group.takes(follower, *controller); };
  auto group = std::find_if(in_lanes_.begin(), in_lanes_.end(), takes);
  if (group == in_lanes_.end()) {
    in_lanes_.emplace_back(lanes_, dt_, follower, controller);
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

void GuidedBlock::advance(std::vector<Follower>& followers, std::int64_t n, std::int64_t log_every,
                          SharedPoll& poll) {
  for (Follower& follower : followers) add(follower);
  const auto has_log = [](const Follower& follower) { return follower.guided->log != nullptr; };
  const auto flies = [](const Follower& follower) { return !follower.has_left; };
  if (std::none_of(followers.begin(), followers.end(), has_log)) log_every = std::max(n, log_every);
  std::int64_t step = 0, next_poll = 0;
  lanes_.show(block_, work_);
  for (const Follower& follower : followers) log(follower, 0);
  begin_rates();
  const auto advance_to = [&](std::int64_t next) {
    this->step(followers, next - step);
    step = next;
    lanes_.show(block_, work_);
    if (step % log_every != 0) return;
    for (const Follower& follower : followers) {
      if (!follower.has_left) log(follower, static_cast<double>(step));
    }
  };
  const auto advance = [&] {
    while (step < n && std::any_of(followers.begin(), followers.end(), flies)) {
      if (step >= next_poll) {
        poll();
        next_poll = step + steps_between_polls;
      }
      const std::int64_t logged = (step / log_every + 1) * log_every;
      const auto end = static_cast<double>(std::min({n, logged, next_poll}));
      advance_to(static_cast<std::int64_t>(update(static_cast<double>(step), end)));
    }
  };
  finally(advance, [&] { finish(followers); });
}

void GuidedBlock::finish(const std::vector<Follower>& followers) const {
  for (const Follower& follower : followers) {
    follower.guided->rate_variation = list_sums(rates_, follower.lane());
  }
  for (const LaneControls& group : in_lanes_) group.finish();
  for (const Control& control : alone_) {
    control.follower->guided->command_variation = control.commands.sums();
  }
}

/// Call the controllers that are due. Returns the next step at which one is due or a command takes
/// effect, or `next` if that is earlier.
double GuidedBlock::update(double step, double next) {
  for (LaneControls& group : in_lanes_) {
    group.update(step, work_);
    next = std::min(next, group.next_event(step));
  }
  for (Control& control : alone_) {
    if (control.follower->has_left) continue;
    update(control, step);
    next = std::min(next, control.schedule.next_event(step, dt_, control.pending.data()));
  }
  return next;
}

void GuidedBlock::step(std::vector<Follower>& followers, std::int64_t count) {
  std::int64_t flown[widest_lanes];
  lanes_.step(block_, count, dt_, work_, flown, rates_.data());
  for (Follower& follower : followers) {
    follower.steps += flown[follower.lane()];
    if (flown[follower.lane()] < count) follower.leave(lanes_);
  }
}

/// Take the joint rates at the start from the shown state.
void GuidedBlock::begin_rates() {
  for (std::size_t i = 0; i < lanes_.rotors(); ++i) {
    const double* const rates = work_ + StateRow::joint(StateRow::joint_rate, i) * widest_lanes;
    for (std::size_t lane = 0; lane < widest_lanes; ++lane) {
      laws::begin_variation(&rates_[i * laws::VariationRow::count * widest_lanes + lane],
                            rates[lane]);
    }
  }
}

void GuidedBlock::update(Control& control, double step) {
  try {
    const double* const speeds = control.schedule.update(
        step, dt_, control.pending.data(), [&](double period, double* asked) {
          BatchGuided& guided = *control.follower->guided;
          count_call(guided.calls, guided.seconds, [&] { command(control, step, period, asked); });
        });
    if (speeds) take(control, speeds);
  } catch (const std::exception&) {  // outside the lanes, the error ends the flight
    control.follower->leave(lanes_);
  }
}

/// Command the rotors of a follower.
void GuidedBlock::take(Control& control, const double* speeds) {
  Follower& follower = *control.follower;
  const std::size_t rotors = follower.guide->controller->rotors();
  follower.speeds.assign(speeds, speeds + rotors);
  const bool are_finite =
      std::all_of(speeds, speeds + rotors, [](double speed) { return std::isfinite(speed); });
  if (!are_finite) return follower.leave(lanes_);
  lanes_.command(follower.vehicle, speeds);
  control.commands.add(speeds);
}

void GuidedBlock::command(Control& control, double step, double period, double* speeds) {
  const Follower& follower = *control.follower;
  const OdometryErrors& errors = *follower.errors;
  const messages::Odometry odometry = measure(work_ + follower.lane(), errors, follower.seed,
                                              follower.draws + step * errors.draws());
  const control::ReferencePreview::Point& point = control.preview->at(
      step * dt_, *follower.guide->reference, [&](double* times, std::size_t count) {
        list_call_times(control.schedule, step, dt_, times, count);
      });
  double* const memory = control.memory.data();
  const std::optional<control::FlatState> flat = point.flat_state();
  follower.guide->controller->command(period, odometry, point.wanted, memory, speeds,
                                      flat ? &*flat : nullptr);
  follower.guided->saturated += control::Controller::saturated(memory);
}

void GuidedBlock::log(const Follower& follower, double step) const {
  double* row = follower.guided->log;
  if (!row) return;
  row += static_cast<std::size_t>(follower.guided->rows) * log_width(lanes_.rotors());
  *row++ = step * dt_;
  for (std::size_t i = 0; i < StateRow::joints; ++i) *row++ = shown(i, follower);
  for (std::size_t i = 0; i < lanes_.rotors(); ++i) {
    *row++ = shown(StateRow::joint(StateRow::joint_rate, i), follower);
  }
  ++follower.guided->rows;
}

void follow_apart(Simulation& simulation, const BatchGuide& guide, const std::string& odometry,
                  std::int64_t n, std::int64_t log_every, BatchGuided& guided, SharedPoll& poll) {
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
  const auto call = [&](double period, double* speeds) {
    count_call(guided.calls, guided.seconds,
               [&] { controller.command(period, topic, *guide.reference, list_times, speeds); });
    guided.saturated += controller.saturated();
  };
  const auto advance = [&] {
    flight.make_room(n);
    for (std::int64_t left = n; left > 0; left -= steps_between_polls) {
      poll();
      loop.advance(std::min(left, steps_between_polls), call);
    }
  };
  finally(advance, finish);
}

}  // namespace quadcore::batch
