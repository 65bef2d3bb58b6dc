#include "quadcore/control/single_lane.hpp"

#include "flat_table.hpp"
#include "lane_controller.hpp"
#include "lanes/for_each_width.hpp"
#include "numbers.hpp"
#include "quadcore/lane_width.hpp"

namespace quadcore::control {

static_assert(size_of<MeasuredNumbers> == 13, "These are the first values of odometry.");

SingleLane::SingleLane() : width_(lane_width()) {}

bool SingleLane::prepare(double period, const Controller& controller, double* state) {
  if (period != period_) lanes_ = controller.in_lanes(period);
  period_ = period;
  if (lanes_) controller.set_period(period, state);
  return lanes_ != nullptr;
}

void SingleLane::command(const Controller& controller, const double* now,
                         const ReferencePreview::Point& wanted, double* state,
                         double* speeds) const {
  static constexpr laws::ForEachWidth<void(const CommandBlock&)> calls{
      &command_single<1>, &command_single<2>, &command_single<4>, &command_single<8>};
  const WantedNumbers<double> reference = numbers_of(wanted);
  DemandNumbers<double> demand;
  std::int64_t is_complete;
  const auto numbers = [](auto& of) { return reinterpret_cast<double*>(&of); };
  calls[width_]({lanes_->wrench_controller.kind, lanes_->wrench_controller.switches, 1,
                 lanes_->rotors, lanes_->wrench_controller.numbers.size(), lanes_->state.size(),
                 period_, !Controller::has_begun(state), lanes_->wrench_controller.numbers.data(),
                 lanes_->actuators.data(), now, reinterpret_cast<const double*>(&reference), state,
                 numbers(demand), speeds, &is_complete});
  if (is_complete == 0) controller.act(period_, demand_of(demand), state, speeds);
}

}  // namespace quadcore::control
