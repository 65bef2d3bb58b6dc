#pragma once

#include <optional>
#include <vector>

#include "attitude_formulas.hpp"
#include "lane_controller.hpp"
#include "quadcore/control/attitude_loop.hpp"
#include "quadcore/control/reference_preview.hpp"
#include "quadcore/control/wrench_controller.hpp"

/// \file
/// Conversions between Eigen's types and plain numbers.

namespace quadcore::control {

inline Vec3<double> numbers_of(const Vector3d& v) { return laws::vec(v.data()); }
inline Matrix3<double> numbers_of(const Matrix3d& m) { return laws::matrix(m.data()); }
inline Quaternion<double> numbers_of(const Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }
inline Vector3d vector_of(const Vec3<double>& v) { return {v.x, v.y, v.z}; }
inline Matrix3d matrix_of(const Matrix3<double>& m) {
  Matrix3d matrix;
  matrix << m.xx, m.xy, m.xz, m.yx, m.yy, m.yz, m.zx, m.zy, m.zz;
  return matrix;
}

/// Return the numbers of a struct one after another.
template <class Numbers>
std::vector<double> list_numbers(const Numbers& numbers) {
  const auto* const first = reinterpret_cast<const double*>(&numbers);
  return {first, first + sizeof numbers / sizeof(double)};
}
/// Return a control law's memory.
template <template <class> class Memory>
Memory<double>& memory_of(double* numbers) {
  return *reinterpret_cast<Memory<double>*>(numbers);
}

/// Return the parts of an air resistance that the force depends on.
AirNumbers<double> numbers_of(const AirResistance& air);
VehicleNumbers<double> numbers_of(const ModelledVehicle& model);
AttitudeNumbers<double> numbers_of(const AttitudeGains& gains);
MeasuredNumbers<double> numbers_of(const Odometry& now);
/// \param flat  null for a control law that does not use it
WantedNumbers<double> numbers_of(const Reference& wanted, const FlatState* flat);
WantedNumbers<double> numbers_of(const ReferencePreview::Point& wanted);
Demand demand_of(const DemandNumbers<double>& demand);

/// Call a control law with the numbers of its input and return its demand.
/// \param model  see flat_state()
template <class Function>
Demand call_with_numbers(const ControllerInput& input, WrenchController::Feeds feeds,
                         const ModelledVehicle& model, const Function& function) {
  using Feeds = WrenchController::Feeds;
  const FlatState* flat = feeds == Feeds::nothing ? nullptr : input.flat;
  std::optional<FlatState> computed;
  if (feeds != Feeds::nothing && !flat) {
    flat = &computed.emplace(flat_state(input.wanted, model, feeds == Feeds::flat_state_with_drag));
  }
  const MeasuredNumbers<double> now = numbers_of(input.now);
  const WantedNumbers<double> wanted = numbers_of(input.wanted, flat);
  const RotorsNumbers<double> rotors{{input.exerted.thrust, numbers_of(input.exerted.torque_F)},
                                     numbers_of(input.h_F),
                                     input.saturated ? 1.0 : 0.0};
  return demand_of(function(InputNumbers<double>{input.period, input.begins, now, wanted, rotors}));
}

}  // namespace quadcore::control
