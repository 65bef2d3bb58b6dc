#include "lane_blocks.hpp"

#include <algorithm>

#include "eigen/gyrostat_step.hpp"
#include "lanes/for_each_width.hpp"
#include "laws/motor_target.hpp"
#include "quadcore/lane_width.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::batch {
namespace {

/// Where a vehicle still flies for certain; a Simulation of it says where it does not.
constexpr double sure_distance = 1e8;                      // m
constexpr double sure_speed = 1e5;                         // m/s
constexpr double sure_rate = Simulation::max_rate / 10.0;  // rad/s

double square(double a) { return a * a; }

}  // namespace

LaneBlocks::LaneBlocks(const std::vector<std::shared_ptr<const LaneVehicle>>& vehicles,
                       std::size_t rotors, const Vector3d& gravity_W)
    : rotors_(rotors), gravity_W_(gravity_W), constants_differ_(false) {
  static constexpr laws::ForEachWidth<void(const Block&, std::int64_t, double)> steps{
      &step_block<1>, &step_block<2>, &step_block<4>, &step_block<8>};
  static constexpr laws::ForEachWidth<void(const Block&, double*)> shows{
      &show_block<1>, &show_block<2>, &show_block<4>, &show_block<8>};
  const int width = lane_width(widest_lanes);
  step_ = steps[width];
  show_ = shows[width];

  const LaneVehicle* first = nullptr;
  bounds_ = {unbounded,        false, -unbounded, square(sure_distance), square(sure_speed),
             square(sure_rate)};
  for (const auto& vehicle : vehicles) {
    if (!vehicle) continue;
    if (!first) first = vehicle.get();
    constants_differ_ |= vehicle->constants != first->constants;
    bounds_.fastest = std::min(bounds_.fastest, vehicle->fastest);
    bounds_.no_tilt |= vehicle->no_tilt;
    bounds_.reach = std::max(bounds_.reach, vehicle->reach);
  }
  const std::size_t places = (vehicles.size() + widest_lanes - 1) / widest_lanes * widest_lanes;
  flies_.resize(places);
  if (!first) return;
  laws_ = first->laws;
  places_ = first->places;

  const std::size_t rows = ConstantRow::count(rotors);
  constants_.resize(rows * (constants_differ_ ? places : widest_lanes));
  state_.resize(StateRow::count(rotors) * places);
  motors_.resize(MotorRow::count * rotors * places);
  may_tilt_.resize(places);
  for (std::size_t i = 0; i < places; ++i) {
    const bool is_in = i < vehicles.size() && vehicles[i];
    const LaneVehicle& vehicle = is_in ? *vehicles[i] : *first;  // an empty place is flown, too
    flies_[i] = -std::int64_t{is_in};
    column(state_, StateRow::count(rotors), i)[(StateRow::orientation + 3) * widest_lanes] = 1;
    if (!constants_differ_ && i >= widest_lanes) continue;
    double* constants = column(constants_, rows, i);
    for (std::size_t row = 0; row < rows; ++row) {
      constants[row * widest_lanes] = vehicle.constants[row];
    }
  }
}

void LaneBlocks::begin(std::size_t vehicle, const std::vector<double>& engine_state) {
  set_engine_state(vehicle, engine_state);
  let_fly(vehicle, true);
  let_tilt(vehicle, false);
  double* motors = column(motors_, MotorRow::count * rotors_, vehicle);
  for (std::size_t i = 0; i < rotors_; ++i) {
    motors[(i * MotorRow::count + MotorRow::active) * widest_lanes] = 0;
  }
}

void LaneBlocks::command(std::size_t vehicle, const double* speeds) {
  if (is_empty()) return;
  double* motors = column(motors_, MotorRow::count * rotors_, vehicle);
  const double* constants = column(constants_, ConstantRow::count(rotors_),
                                   constants_differ_ ? vehicle : vehicle % widest_lanes);
  const double fastest = constants[ConstantRow::fastest * widest_lanes],
               sim_slow = constants[ConstantRow::motors_sim_slow * widest_lanes];
  for (std::size_t i = 0; i < rotors_; ++i) {
    if (places_[i] < 0) continue;
    double* rows = motors + i * MotorRow::count * widest_lanes;
    rows[MotorRow::active * widest_lanes] = 1;
    rows[MotorRow::target * widest_lanes] =
        laws::motor_target(speeds[places_[i]], fastest, sim_slow);
  }
}

Block LaneBlocks::view(std::size_t block, double* work, std::int64_t* steps) {
  const auto part = [block](LaneNumbers& table, std::size_t rows) {
    return table.data() + block * rows * widest_lanes;
  };
  const std::size_t first = block * widest_lanes;
  return {rotors_,
          laws_,
          bounds_,
          {gravity_W_.x(), gravity_W_.y(), gravity_W_.z()},
          part(constants_, constants_differ_ ? ConstantRow::count(rotors_) : 0),
          part(motors_, MotorRow::count * rotors_),
          &flies_[first],
          &may_tilt_[first],
          part(state_, StateRow::count(rotors_)),
          work,
          steps};
}

void LaneBlocks::step(std::size_t block, std::int64_t count, double dt, double* work,
                      std::int64_t* steps) {
  std::fill_n(steps, widest_lanes, 0);
  if (!is_empty()) step_(view(block, work, steps), count, dt);
}

void LaneBlocks::show(std::size_t block, std::size_t vehicles, double* work, double* rows) const {
  if (is_empty()) return;
  show_(const_cast<LaneBlocks*>(this)->view(block, nullptr, nullptr), work);
  const std::size_t width = state_rows();
  for (std::size_t i = 0; i < vehicles; ++i) {
    double* to = rows + i * width;
    for (std::size_t row = 0; row < StateRow::joints; ++row) to[row] = work[row * widest_lanes + i];
    for (std::size_t j = 0; j < rotors_; ++j) {
      const auto joint = [&](std::size_t row) {
        return work[StateRow::joint(row, j) * widest_lanes + i];
      };
      to[StateRow::joints + j] = joint(StateRow::joint_rate);
      to[StateRow::joints + rotors_ + j] = joint(StateRow::joint_angle);
    }
  }
}

namespace {

/// Calls f(row here, place there) for each number that a state has both here and in the engine.
template <class Function>
void for_each_number(std::size_t rotors, const Function& f) {
  using There = GyrostatState;
  for (std::size_t k = 0; k < 3; ++k) f(StateRow::position + k, There::position + k);
  for (std::size_t k = 0; k < 4; ++k) f(StateRow::orientation + k, There::orientation + k);
  for (std::size_t k = 0; k < 3; ++k) f(StateRow::velocity + k, There::velocity + k);
  for (std::size_t k = 0; k < 3; ++k) f(StateRow::rate + k, There::rate + k);
  for (std::size_t i = 0; i < rotors; ++i) {
    const std::size_t joint = There::joints + rotor_offset(There::joint_rows, i);
    f(StateRow::joint(StateRow::joint_rate, i), joint + There::joint_rate * widest_lanes);
    f(StateRow::joint(StateRow::joint_angle, i), joint + There::joint_angle * widest_lanes);
  }
}

}  // namespace

void LaneBlocks::get_engine_state(std::size_t vehicle, std::vector<double>& engine) const {
  const double* rows = column(state_, state_rows(), vehicle);
  for_each_number(rotors_, [&](std::size_t row, std::size_t place) {
    engine[place] = rows[row * widest_lanes];
  });
}

void LaneBlocks::set_engine_state(std::size_t vehicle, const std::vector<double>& engine) {
  double* rows = column(state_, state_rows(), vehicle);
  for_each_number(rotors_, [&](std::size_t row, std::size_t place) {
    rows[row * widest_lanes] = engine[place];
  });
}

}  // namespace quadcore::batch
