#include "flat_table.hpp"

#include <algorithm>

#include "lanes/for_each_width.hpp"
#include "numbers.hpp"
#include "quadcore/lane_width.hpp"
#include "quadcore/plugin/elementary.hpp"

namespace quadcore::control {
namespace {

FlatVehicle describe_flatly(const ModelledVehicle& model, bool with_drag) {
  FlatVehicle vehicle{};
  vehicle.mass = model.mass;
  vehicle.gravity = model.gravity;
  vehicle.with_drag = with_drag;
  vehicle.mean_drag = (model.air.linear(0, 0) + model.air.linear(1, 1)) / 2;
  vehicle.air = numbers_of(model.air);
  vehicle.is_offset = !model.p_FCcm_F.isZero(0);
  std::copy_n(model.p_FCcm_F.data(), 3, vehicle.p_FCcm_F);
  return vehicle;
}

}  // namespace

FlatTable::FlatTable(const ModelledVehicle& model, bool with_drag)
    : vehicle_(describe_flatly(model, with_drag)) {}

void FlatTable::set(std::size_t column, const Reference& wanted) {
  const auto put = [&](std::size_t row, const Vector3d& vector) {
    for (std::size_t i = 0; i < 3; ++i) *at(row + i, column) = vector[static_cast<int>(i)];
  };
  put(FlatRow::velocity, wanted.velocity);
  put(FlatRow::acceleration, wanted.acceleration);
  put(FlatRow::jerk, wanted.jerk);
  put(FlatRow::snap, wanted.snap);
  const auto [sine, cosine] = elementary::sincos(wanted.yaw);
  *at(FlatRow::sine, column) = sine;
  *at(FlatRow::cosine, column) = cosine;
  *at(FlatRow::yaw_rate, column) = wanted.yaw_rate;
  *at(FlatRow::yaw_acceleration, column) = wanted.yaw_acceleration;
}

void FlatTable::solve(std::size_t columns) {
  static constexpr laws::ForEachWidth<void(const FlatVehicle&, double*, std::size_t)> solves{
      &solve_flat_states<1>, &solve_flat_states<2>, &solve_flat_states<4>, &solve_flat_states<8>};
  solves[columns == 1 ? 1 : lane_width(columns)](vehicle_, rows_, columns);
}

template <class Vector>
void FlatTable::get(std::size_t row, std::size_t column, Vector&& vector) const {
  for (int i = 0; i < 3; ++i) {
    vector[i] = rows_[(row + static_cast<std::size_t>(i)) * widest_lanes + column];
  }
}

void FlatTable::get_state(std::size_t column, std::optional<FlatState>& state) const {
  FlatState& flat = state ? *state : state.emplace();
  for (int i = 0; i < 3; ++i) {
    get(FlatRow::R_WF + 3 * static_cast<std::size_t>(i), column, flat.R_WF.col(i));
  }
  if (!flat.R_WF.allFinite()) return state.reset();
  get(FlatRow::w_WF_F, column, flat.w_WF_F);
  get(FlatRow::dw_WF_F, column, flat.dw_WF_F);
  get(FlatRow::a_FCcm_W, column, flat.a_FCcm_W);
  flat.across_W << -rows_[FlatRow::sine * widest_lanes + column],
      rows_[FlatRow::cosine * widest_lanes + column], 0;
  flat.thrust = rows_[FlatRow::thrust * widest_lanes + column];
}

}  // namespace quadcore::control
