#include "lane_controls.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include "actuation_formulas.hpp"
#include "lanes/for_each_width.hpp"
#include "laws/variation.hpp"
#include "measure_block.hpp"
#include "numbers.hpp"
#include "quadcore/lane_width.hpp"
#include "quadcore/plugin/counts.hpp"

namespace quadcore::batch {
namespace {

using control::size_of;
using laws::VariationRow;

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

LaneControls::LaneControls(LaneBlocks& lanes, double dt, const Follower& like,
                           std::shared_ptr<const control::LaneController> controller)
    : lanes_(lanes),
      dt_(dt),
      like_(std::move(controller)),
      rate_(like.guide->rate),
      delay_(like.guide->delay),
      errors_(like.errors),
      rotors_(like_->rotors),
      width_(lane_width()),
      schedule_(rate_, delay_, rotors_ * widest_lanes),
      pending_(schedule_.state_size()),
      numbers_(width_, like_->wrench_controller.numbers.size()),
      actuators_(width_, like_->actuators.size()),
      sensors_(width_, size_of<ErrorNumbers>),
      measured_(width_, size_of<control::MeasuredNumbers>),
      wanted_(width_, size_of<control::WantedNumbers>),
      state_(width_, like_->state.size()),
      demand_(width_, size_of<control::DemandNumbers>),
      asked_(width_, rotors_),
      in_effect_(width_, rotors_),
      variation_(rotors_ * VariationRow::count * widest_lanes) {}

bool LaneControls::takes(const Follower& follower,
                         const control::LaneController& controller) const {
  return follower.guide->rate == rate_ && follower.guide->delay == delay_ &&
         control::are_alike(*like_, controller) && measure_alike(*errors_, *follower.errors);
}

void LaneControls::add(Follower& follower, const control::LaneController& controller,
                       control::ReferencePreview& preview) {
  const std::size_t lane = follower.lane();
  followers_.push_back(&follower);
  const auto reads = [&](const Followed& followed) { return followed.preview == &preview; };
  auto followed = std::find_if(followed_.begin(), followed_.end(), reads);
  if (followed == followed_.end()) {
    followed_.push_back({&preview, {}});
    followed = followed_.end() - 1;
  }
  followed->followers.push_back(&follower);
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
  begins_[lane] = count_of(follower.draws);
  belong_[lane] = -1;
}

void LaneControls::update(double step, const double* shown) {
  const double* const speeds =
      schedule_.update(step, dt_, pending_.data(), [&](double period, double* asked) {
        count_call(calls_, seconds_, [&] { call(step, period, shown); });
        std::copy_n(asked_.data(), asked_.size(), asked);
      });
  if (!speeds) return;
  std::copy_n(speeds, in_effect_.size(), in_effect_.data());
  take();
}

void LaneControls::call(double step, double period, const double* shown) {
  measure(step, shown);
  read_references(step);
  command(period);
  state_.add_row(control::ActuationRow::saturated, saturated_);
}

void LaneControls::measure(double step, const double* shown) {
  static constexpr laws::ForEachWidth<void(const MeasureBlock&)> measures{
      &measure_block<1>, &measure_block<2>, &measure_block<4>, &measure_block<8>};
  MeasureBlock block{
      shown,           {}, {}, sensors_.data(), seeds_, begins_, count_of(step * errors_->draws()),
      measured_.data()};
  const auto errors = list_errors(*errors_);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    block.is_noisy[i] = errors[i].noise != 0;
    block.is_quantised[i] = errors[i].resolution != 0;
  }
  measures[width_](block);
}

void LaneControls::read_references(double step) {
  const auto list_times = [&](double* times, std::size_t count) {
    list_call_times(schedule_, step, dt_, times, count);
  };
  for (const Followed& followed : followed_) {
    const BatchGuide& guide = *followed.followers.front()->guide;
    const control::ReferencePreview::Point& point =
        followed.preview->at(step * dt_, *guide.reference, std::cref(list_times));
    const auto wanted = control::numbers_of(point);
    const auto* const column = reinterpret_cast<const double*>(&wanted);
    const bool feeds = guide.controller->feeds() != control::WrenchController::Feeds::nothing;
    if (&followed == &followed_.front()) {
      wanted_.fill(column);  // also the unused vehicles
    } else {
      for (const Follower* follower : followed.followers) wanted_.put(follower->lane(), column);
    }
    if (!feeds || point.flat) continue;
    for (Follower* follower : followed.followers) follower->leave(lanes_);
  }
}

void LaneControls::command(double period) {
  static constexpr laws::ForEachWidth<void(const control::CommandBlock&)> calls{
      &control::command_block<1>, &control::command_block<2>, &control::command_block<4>,
      &control::command_block<8>};
  std::int64_t complete[widest_lanes];
  calls[width_]({like_->wrench_controller.kind, like_->wrench_controller.switches, widest_lanes,
                 rotors_, like_->wrench_controller.numbers.size(), like_->state.size(), period,
                 !has_begun_, numbers_.data(), actuators_.data(), measured_.data(), wanted_.data(),
                 state_.data(), demand_.data(), asked_.data(), complete});
  has_begun_ = true;
  for (const Follower* follower : followers_) {
    const std::size_t lane = follower->lane();
    if (complete[lane] != 0 || follower->has_left) continue;
    std::vector<double> state(like_->state.size()), speeds(rotors_);
    control::DemandNumbers<double> demand{};
    demand_.get(lane, reinterpret_cast<double*>(&demand));
    state_.get(lane, state.data());
    follower->guide->controller->act(period, control::demand_of(demand), state.data(),
                                     speeds.data());
    state_.put(lane, state.data());
    asked_.put(lane, speeds.data());
  }
}

void LaneControls::take() {
  std::int64_t are_finite[widest_lanes];
  const std::size_t block = followers_.front()->vehicle / widest_lanes;
  lanes_.command(
      block, {rotors_, in_effect_.data(), belong_, !has_commanded_, variation_.data(), are_finite});
  has_commanded_ = true;
  for (Follower* follower : followers_) {
    if (are_finite[follower->lane()] == 0) follower->leave(lanes_);
  }
}

void LaneControls::finish() const {
  for (Follower* follower : followers_) {
    const std::size_t lane = follower->lane();
    BatchGuided& guided = *follower->guided;
    guided.calls = calls_;
    guided.saturated = static_cast<std::int64_t>(saturated_[lane]);
    for (const double seconds : seconds_) {
      guided.seconds.push_back(seconds / static_cast<double>(followers_.size()));
    }
    guided.command_variation = list_sums(variation_, lane);
    if (!has_commanded_) continue;
    follower->speeds.resize(rotors_);
    in_effect_.get(lane, follower->speeds.data());
  }
}

}  // namespace quadcore::batch
