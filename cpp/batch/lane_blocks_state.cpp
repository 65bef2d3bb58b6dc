#include <algorithm>

#include "eigen/gyrostat_step.hpp"
#include "hinged_block.hpp"
#include "lane_blocks.hpp"
#include "lanes/quaternion.hpp"
#include "ode/body_state.hpp"

namespace quadcore::batch {
namespace {

/// Call f(row here, place there) for each number that a state has both here and in the engine.
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

/// The same for bodies on hinges.
template <class Function>
void for_each_hinged_number(std::size_t rotors, const Function& f) {
  for (std::size_t i = 0; i <= rotors; ++i) {
    const std::size_t here = i * BodyRow::count, there = i * (pose_size + velocity_size);
    for (std::size_t k = 0; k < 3; ++k) {
      f(here + BodyRow::position + k, there + k);
      f(here + BodyRow::orientation + k, there + 4 + k);
      f(here + BodyRow::velocity + k, there + pose_size + k);
      f(here + BodyRow::rate + k, there + pose_size + 3 + k);
    }
    f(here + BodyRow::orientation + 3, there + 3);
  }
}

/// Write the rotations of the quaternions.
void turn_hinged(std::size_t rotors, double* engine) {
  for (std::size_t i = 0; i <= rotors; ++i) {
    const double* const q = engine + i * (pose_size + velocity_size) + 3;
    const auto R = laws::rotation(laws::Quaternion<double>{q[1], q[2], q[3], q[0]});
    const double rows[] = {R.xx, R.xy, R.xz, 0, R.yx, R.yy, R.yz, 0, R.zx, R.zy, R.zz, 0};
    std::copy_n(rows, 12, engine + i * (pose_size + velocity_size) + 7);
  }
}

}  // namespace

void LaneBlocks::get_engine_state(std::size_t vehicle, std::vector<double>& engine) const {
  const double* rows = column(state_, state_rows(), vehicle);
  bool moved = false;
  const auto get = [&](std::size_t row, std::size_t place) {
    moved |= engine[place] != rows[row * widest_lanes];
    engine[place] = rows[row * widest_lanes];
  };
  if (!are_hinged()) return for_each_number(rotors_, get);
  if (has_contact_) engine = of_contact_[vehicle];
  for_each_hinged_number(rotors_, get);
  if (moved) turn_hinged(rotors_, engine.data());
}

void LaneBlocks::set_engine_state(std::size_t vehicle, const std::vector<double>& engine) {
  double* rows = column(state_, state_rows(), vehicle);
  const auto set = [&](std::size_t row, std::size_t place) {
    rows[row * widest_lanes] = engine[place];
  };
  if (!are_hinged()) return for_each_number(rotors_, set);
  for_each_hinged_number(rotors_, set);
  if (has_contact_) of_contact_[vehicle] = engine;
}

}  // namespace quadcore::batch
