#include "lane_controls.hpp"

#include <algorithm>
#include <array>

#include "actuation_formulas.hpp"
#include "lanes/for_each_width.hpp"
#include "measure_block.hpp"
#include "numbers.hpp"
#include "quadcore/lane_width.hpp"
#include "quadcore/plugin/counts.hpp"

namespace quadcore::batch {
namespace {

using control::size_of;

/// Errors of each quantity, in the order of ErrorNumbers.
std::array<VectorErrors, measured_quantities> list_errors(const OdometryErrors& errors) {
  return {errors.position, errors.orientation, errors.linear_velocity, errors.angular_velocity};
}

/// Return whether the measurements of two sensors differ only by numbers.
bool measure_alike(const OdometryErrors& a, const OdometryErrors& b) {
  const auto of_a = list_errors(a), of_b = list_errors(b);
  return std::equal(of_a.begin(), of_a.end(), of_b.begin(),
                    [](const VectorErrors& one, const VectorErrors& other) {
                      return (one.noise != 0) == (other.noise != 0) &&
                             (one.resolution != 0) == (other.resolution != 0);
                    });
}

}  // namespace

void PackTable::fill(const double* column) {
  for (std::size_t part = 0; part < widest_lanes / width_; ++part) {
    for (std::size_t row = 0; row < rows_; ++row) {
      std::fill_n(&numbers_[(part * rows_ + row) * width_], width_, column[row]);
    }
  }
}

LaneControls::LaneControls(const Follower& like,
                           std::shared_ptr<const control::LaneController> controller)
    : like_(std::move(controller)),
      rate_(like.guide->rate),
      delay_(like.guide->delay),
      errors_(like.errors),
      rotors_(like_->rotors),
      width_(lane_width(widest_lanes)),
      schedule_(rate_, delay_, rotors_ * widest_lanes),
      pending_(schedule_.state_size()),
      numbers_(width_, like_->wrench_controller.numbers.size()),
      actuators_(width_, like_->actuators.size()),
      sensors_(width_, size_of<ErrorNumbers>),
      measured_(width_, size_of<control::MeasuredNumbers>),
      wanted_(width_, size_of<control::WantedNumbers>),
      state_(width_, like_->state.size()),
      demand_(width_, size_of<control::DemandNumbers>),
      speeds_(width_, rotors_) {}

bool LaneControls::takes(const Follower& follower,
                         const control::LaneController& controller) const {
  return follower.guide->rate == rate_ && follower.guide->delay == delay_ &&
         control::are_alike(*like_, controller) && measure_alike(*errors_, *follower.errors);
}

void LaneControls::add(Follower& follower, const control::LaneController& controller,
                       control::ReferencePreview& preview) {
  const std::size_t lane = follower.lane();
  members_.push_back({&follower, lane, &preview, true});
  numbers_.put(lane, controller.wrench_controller.numbers.data());
  actuators_.put(lane, controller.actuators.data());
  state_.put(lane, controller.state.data());
  ErrorNumbers<double> errors{};
  const auto listed = list_errors(*follower.errors);
  for (std::size_t i = 0; i < listed.size(); ++i) {
    errors.noise[i] = listed[i].noise;
    errors.resolution[i] = listed[i].resolution;
  }
  sensors_.put(lane, control::list_numbers(errors).data());
  seeds_[lane] = follower.seed;
}

void LaneControls::command(double step, double dt, double period, const double* shown,
                           double* speeds) {
  bool is_timed = false;
  for (const Member& member : members_) is_timed = count_call(*member.follower->guided);
  const Stopwatch stopwatch;
  measure(step, shown);
  read_references(step, dt);
  call(period);
  const double seconds = is_timed ? stopwatch.seconds() : 0;
  for (const Member& member : members_) {
    speeds_.get(member.lane, speeds + member.lane * rotors_);
    BatchGuided& guided = *member.follower->guided;
    guided.saturated += state_.at(control::ActuationRow::saturated, member.lane) != 0;
    if (is_timed) guided.seconds.push_back(seconds / static_cast<double>(members_.size()));
  }
}

void LaneControls::measure(double step, const double* shown) {
  static constexpr laws::ForEachWidth<void(const MeasureBlock&)> measures{
      &measure_block<1>, &measure_block<2>, &measure_block<4>, &measure_block<8>};
  for (const Member& member : members_) {
    const Follower& follower = *member.follower;
    counts_[member.lane] = count_of(follower.draws + step * follower.errors->draws());
  }
  MeasureBlock block{shown, {}, {}, sensors_.data(), seeds_, counts_, measured_.data()};
  const auto errors = list_errors(*errors_);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    block.is_noisy[i] = errors[i].noise != 0;
    block.is_quantised[i] = errors[i].resolution != 0;
  }
  measures[width_](block);
}

void LaneControls::read_references(double step, double dt) {
  // Made once, because it allocates memory.
  const control::ReferencePreview::ListTimes list_times = [&](double* times, std::size_t count) {
    double at = step;
    for (std::size_t i = 0; i < count; ++i) {
      times[i] = at * dt;
      at = schedule_.next_call(at, dt);
    }
  };
  const control::ReferencePreview* of_all = nullptr;
  for (Member& member : members_) {
    const BatchGuide& guide = *member.follower->guide;
    const control::ReferencePreview::Point& point =
        member.preview->at(step * dt, *guide.reference, list_times);
    const bool feeds = guide.controller->feeds() != control::WrenchController::Feeds::nothing;
    member.is_defined = point.flat || !feeds;
    if (member.preview == of_all) continue;
    const auto wanted = control::numbers_of(point);
    const auto* const column = reinterpret_cast<const double*>(&wanted);
    if (of_all) {
      wanted_.put(member.lane, column);
    } else {
      wanted_.fill(column);
      of_all = member.preview;
    }
  }
}

void LaneControls::call(double period) {
  static constexpr laws::ForEachWidth<void(const control::CommandBlock&)> calls{
      &control::command_block<1>, &control::command_block<2>, &control::command_block<4>,
      &control::command_block<8>};
  std::int64_t complete[widest_lanes];
  calls[width_]({like_->wrench_controller.kind, like_->wrench_controller.switches, widest_lanes,
                 rotors_, like_->wrench_controller.numbers.size(), like_->state.size(), period,
                 !has_begun_, numbers_.data(), actuators_.data(), measured_.data(), wanted_.data(),
                 state_.data(), demand_.data(), speeds_.data(), complete});
  has_begun_ = true;
  for (const Member& member : members_) {
    if (complete[member.lane] != 0 || member.follower->has_left) continue;
    std::vector<double> state(like_->state.size()), speeds(rotors_);
    control::DemandNumbers<double> demand{};
    demand_.get(member.lane, reinterpret_cast<double*>(&demand));
    state_.get(member.lane, state.data());
    member.follower->guide->controller->act(period, control::demand_of(demand), state.data(),
                                            speeds.data());
    state_.put(member.lane, state.data());
    speeds_.put(member.lane, speeds.data());
  }
}

}  // namespace quadcore::batch
