#include "flat_table.hpp"

#include <algorithm>
#include <cmath>

#include "lanes/for_each_width.hpp"
#include "numbers.hpp"
#include "quadcore/lane_width.hpp"

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
    : vehicle_(describe_flatly(model, with_drag)), width_(lane_width()) {}

void FlatTable::set(std::size_t column, const Reference& wanted,
                    const elementary::SineCosine& of_yaw) {
  const auto put = [&](std::size_t row, const Vector3d& vector) {
    for (std::size_t i = 0; i < 3; ++i) *at(row + i, column) = vector[static_cast<int>(i)];
  };
  put(FlatRow::velocity, wanted.velocity);
  put(FlatRow::acceleration, wanted.acceleration);
  put(FlatRow::jerk, wanted.jerk);
  put(FlatRow::snap, wanted.snap);
  *at(FlatRow::sine, column) = of_yaw.sin;
  *at(FlatRow::cosine, column) = of_yaw.cos;
  *at(FlatRow::yaw_rate, column) = wanted.yaw_rate;
  *at(FlatRow::yaw_acceleration, column) = wanted.yaw_acceleration;
}

void FlatTable::solve(std::size_t columns) {
  static constexpr laws::ForEachWidth<void(const FlatVehicle&, double*, std::size_t)> solves{
      &solve_flat_states<1>, &solve_flat_states<2>, &solve_flat_states<4>, &solve_flat_states<8>};
  solves[columns == 1 ? 1 : width_](vehicle_, rows_, columns);
}

bool FlatTable::is_defined(std::size_t column) const {
  bool all = true;
  for (std::size_t i = 0; i < 9; ++i) all &= std::isfinite(number(FlatRow::R_WF + i, column));
  return all;
}

FlatState FlatTable::state(std::size_t column) const {
  FlatState flat;
  for (int i = 0; i < 3; ++i) {
    flat.R_WF.col(i) = vector_of(vector(FlatRow::R_WF + 3 * static_cast<std::size_t>(i), column));
  }
  flat.w_WF_F = vector_of(vector(FlatRow::w_WF_F, column));
  flat.dw_WF_F = vector_of(vector(FlatRow::dw_WF_F, column));
  flat.a_FCcm_W = vector_of(vector(FlatRow::a_FCcm_W, column));
  flat.across_W << -number(FlatRow::sine, column), number(FlatRow::cosine, column), 0;
  flat.thrust = number(FlatRow::thrust, column);
  return flat;
}

WantedNumbers<double> FlatTable::numbers(const Reference& wanted, std::size_t column) const {
  const Vec3<double> x = vector(FlatRow::R_WF, column), y = vector(FlatRow::R_WF + 3, column),
                     z = vector(FlatRow::R_WF + 6, column);
  return {numbers_of(wanted.position),
          numbers_of(wanted.velocity),
          numbers_of(wanted.acceleration),
          {-number(FlatRow::sine, column), number(FlatRow::cosine, column), 0},
          {x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z},
          vector(FlatRow::w_WF_W, column),
          vector(FlatRow::dw_WF_W, column),
          vector(FlatRow::a_FCcm_W, column),
          number(FlatRow::thrust, column),
          wanted.yaw_rate};
}

}  // namespace quadcore::control
