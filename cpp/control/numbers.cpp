#include "numbers.hpp"

#include <algorithm>

#include "flat_table.hpp"

namespace quadcore::control {

AirNumbers<double> numbers_of(const AirResistance& air) {
  AirNumbers<double> numbers{};
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) numbers.linear[3 * column + row] = air.linear(row, column);
  }
  std::copy_n(air.of_components.data(), 3, numbers.components);
  numbers.quadratic = air.quadratic;
  return numbers;
}

VehicleNumbers<double> numbers_of(const ModelledVehicle& model) {
  const Matrix3d by_velocity = model.air.linear.bottomLeftCorner<3, 3>();
  const Matrix3d by_rate = model.air.linear.bottomRightCorner<3, 3>();
  return {model.mass,
          model.gravity,
          numbers_of(model.p_FCcm_F),
          numbers_of(model.inertia_Ccm_F),
          numbers_of(model.air),
          numbers_of(by_velocity),
          numbers_of(by_rate)};
}

AttitudeNumbers<double> numbers_of(const AttitudeGains& gains) {
  return {{gains.kr_rp, gains.kr_rp, gains.kr_yaw}, {gains.kw_rp, gains.kw_rp, gains.kw_yaw}};
}

MeasuredNumbers<double> numbers_of(const Odometry& now) {
  return {numbers_of(now.position), numbers_of(now.orientation), numbers_of(now.linear_velocity),
          numbers_of(now.angular_velocity)};
}

namespace {

WantedNumbers<double> without_flat_state(const Reference& wanted, const Vec3<double>& across_W) {
  WantedNumbers<double> numbers{};
  numbers.position = numbers_of(wanted.position);
  numbers.velocity = numbers_of(wanted.velocity);
  numbers.acceleration = numbers_of(wanted.acceleration);
  numbers.across_W = across_W;
  numbers.yaw_rate = wanted.yaw_rate;
  return numbers;
}

}  // namespace

WantedNumbers<double> numbers_of(const Reference& wanted, const FlatState* flat) {
  if (!flat) return without_flat_state(wanted, numbers_of(across_yaw(wanted.yaw)));
  WantedNumbers<double> numbers = without_flat_state(wanted, numbers_of(flat->across_W));
  numbers.R_WF = numbers_of(flat->R_WF);
  numbers.w_WF_W = numbers.R_WF * numbers_of(flat->w_WF_F);
  numbers.dw_WF_W = numbers.R_WF * numbers_of(flat->dw_WF_F);
  numbers.a_FCcm_W = numbers_of(flat->a_FCcm_W);
  numbers.thrust = flat->thrust;
  return numbers;
}

WantedNumbers<double> numbers_of(const ReferencePreview::Point& wanted) {
  if (wanted.flat) return wanted.flat->numbers(wanted.wanted, wanted.column);
  return without_flat_state(wanted.wanted, {-wanted.of_yaw.sin, wanted.of_yaw.cos, 0});
}

Demand demand_of(const DemandNumbers<double>& demand) {
  return {demand.thrust, vector_of(demand.torque_F)};
}

}  // namespace quadcore::control
