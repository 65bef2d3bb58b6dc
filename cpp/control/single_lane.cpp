#include "quadcore/control/single_lane.hpp"

#include "lane_controller.hpp"
#include "numbers.hpp"

namespace quadcore::control {

bool SingleLane::prepare(double period, const Controller& controller, double* state) {
  if (period != period_) lanes_ = controller.in_lanes(period);
  period_ = period;
  if (lanes_) controller.set_period(period, state);
  return lanes_ != nullptr;
}

void SingleLane::command(const Controller& controller, const Odometry& now,
                         const ReferencePreview::Point& wanted, double* state,
                         double* speeds) const {
  const MeasuredNumbers<double> measured = numbers_of(now);
  const WantedNumbers<double> reference =
      numbers_of(wanted.wanted, wanted.flat ? &*wanted.flat : nullptr);
  DemandNumbers<double> demand;
  std::int64_t is_complete;
  const auto numbers = [](auto& of) { return reinterpret_cast<double*>(&of); };
  const auto inputs = [](const auto& of) { return reinterpret_cast<const double*>(&of); };
  command_block<1>({lanes_->wrench_controller.kind, lanes_->wrench_controller.switches, 1,
                    lanes_->rotors, lanes_->wrench_controller.numbers.size(), lanes_->state.size(),
                    period_, !Controller::has_begun(state),
                    lanes_->wrench_controller.numbers.data(), lanes_->actuators.data(),
                    inputs(measured), inputs(reference), state, numbers(demand), speeds,
                    &is_complete});
  if (is_complete == 0) controller.act(period_, demand_of(demand), state, speeds);
}

}  // namespace quadcore::control
