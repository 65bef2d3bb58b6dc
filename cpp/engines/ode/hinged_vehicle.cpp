#include "hinged_vehicle.hpp"

#include <algorithm>
#include <cstddef>

#include "body_state.hpp"
#include "body_work.hpp"
#include "laws/rotors.hpp"
#include "ode_math.hpp"

namespace quadcore {
namespace {

using Work = BodyWork<double>;

/// Return the size of tables of so many rows for a vehicle with so many bodies.
std::size_t table_size(std::size_t rows, std::size_t bodies) {
  return rows * widest_lanes + rotor_offset(rows, bodies + widest_lanes);
}

/// Return the start of a body's column; all columns of the frame are equal.
std::size_t column(std::size_t rows, std::size_t body) {
  return body == 0 ? 0 : rows * widest_lanes + rotor_offset(rows, body - 1);
}

/// Write a row of a body and fill the unused columns.
void put(LaneNumbers& table, std::size_t rows, std::size_t row, std::size_t body,
         std::size_t bodies, double number) {
  const std::size_t lane = body == 0 ? 0 : (body - 1) % widest_lanes;
  const bool is_last = body == 0 || body + 1 == bodies;
  double* to = &table[column(rows, body) + row * widest_lanes];
  std::fill_n(to, is_last ? widest_lanes - lane : 1, number);
}

template <class Member>
constexpr std::size_t numbers = sizeof(Member) / sizeof(double);

}  // namespace

#define QUADCORE_NUMBER_OF(member) (offsetof(Work, member) / sizeof(double))

HingedVehicle::HingedVehicle(const Bodies& bodies, const World& world, double max_correction)
    : model_(bodies),
      rotors_(bodies.rotors),
      constants_(table_size(BodyConstant::count, model_.carriers.size())),
      state_(table_size(BodyRow::count, model_.carriers.size())),
      work_(numbers<Work> * (model_.carriers.size() + 2 * widest_lanes)),
      soft_(world.cfm > 0 ? numbers<SoftRows<double>> * (model_.carriers.size() + 2 * widest_lanes)
                          : 0),
      flight_{model_.tree(world, max_correction),
              rotors_.size(),
              rotors_.data(),
              constants_.data(),
              state_.data(),
              work_.data(),
              soft_.empty() ? nullptr : soft_.data()},
      calls_(calls(model_.is_star() ? lane_width() : 1)) {
  const Model& model = bodies.model;
  for (const Joint& joint : model.joints) {
    R_PC_at_zero_.push_back(joint.pose.rotation().toRotationMatrix());
  }
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const std::vector<double> rows = body_constants(model, i);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      put(constants_, rows.size(), row, i, model.links.size(), rows[row]);
    }
  }
}

HingedVehicle::Calls HingedVehicle::calls(int width) {
  const auto of = [](auto lanes) -> Calls {
    constexpr int W = lanes();
    return {laws::rotors_in_pack<W>, &read_hinged<W>,    &clear_hinged<W>, &push_hinged<W>,
            &push_hinged_laws<W>,    &advance_hinged<W>, &show_hinged<W>,  &find_hinge_loads<W>};
  };
  switch (width) {
    case 8:
      return of(std::integral_constant<int, 8>());
    case 4:
      return of(std::integral_constant<int, 4>());
    case 2:
      return of(std::integral_constant<int, 2>());
    default:
      return of(std::integral_constant<int, 1>());
  }
}

double* HingedVehicle::state_of(std::size_t body) const {
  return flight_.state + column(BodyRow::count, body);
}

double* HingedVehicle::work_of(std::size_t body, std::size_t number) const {
  const auto width = static_cast<std::size_t>(calls_.width);
  const std::size_t pack = body == 0 ? 0 : 1 + (body - 1) / width;
  const std::size_t lane = body == 0 ? 0 : (body - 1) % width;
  return flight_.work + (pack * numbers<Work> + number) * width + lane;
}

void HingedVehicle::take(const std::vector<dBodyID>& bodies) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const dReal* const q = dBodyGetQuaternion(bodies[i]);
    double rows[BodyRow::count];
    std::copy_n(dBodyGetPosition(bodies[i]), 3, rows + BodyRow::position);
    std::copy_n(q + 1, 3, rows + BodyRow::orientation);
    rows[BodyRow::orientation + 3] = q[0];
    std::copy_n(dBodyGetLinearVel(bodies[i]), 3, rows + BodyRow::velocity);
    std::copy_n(dBodyGetAngularVel(bodies[i]), 3, rows + BodyRow::rate);
    for (std::size_t row = 0; row < BodyRow::count; ++row) {
      put(state_, BodyRow::count, row, i, bodies.size(), rows[row]);
    }
  }
  calls_.read(flight_);
}

void HingedVehicle::take_forces(const std::vector<dBodyID>& bodies) {
  calls_.clear(flight_);
  const auto width = static_cast<std::size_t>(calls_.width);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    double* const to = work_of(i, QUADCORE_NUMBER_OF(force));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t lanes = i == 0 ? width : 1;
      std::fill_n(to + k * width, lanes, dBodyGetForce(bodies[i])[k]);
      std::fill_n(to + (k + 3) * width, lanes, dBodyGetTorque(bodies[i])[k]);
    }
  }
}

void HingedVehicle::give(const std::vector<dBodyID>& bodies) const {
  const auto width = static_cast<std::size_t>(calls_.width);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    double rows[BodyRow::count];
    for (std::size_t row = 0; row < BodyRow::count; ++row) {
      rows[row] = state_of(i)[row * widest_lanes];
    }
    const double* const R = work_of(i, QUADCORE_NUMBER_OF(R_WB));
    double pose[pose_size] = {};
    std::copy_n(rows + BodyRow::position, 3, pose);
    pose[3] = rows[BodyRow::orientation + 3];
    std::copy_n(rows + BodyRow::orientation, 3, pose + 4);
    for (std::size_t k = 0; k < 9; ++k) pose[7 + k / 3 * 4 + k % 3] = R[k * width];
    restore_pose(bodies[i], pose);
    restore_velocity(bodies[i], rows + BodyRow::velocity);
    forget_forces(bodies[i]);
  }
}

void HingedVehicle::push(const Loads& loads) {
  const Wrench frame = loads.frame();
  calls_.clear(flight_);
  calls_.push(flight_, {frame.force_F.data(), frame.torque_F.data(), loads.rotors().data()});
}

bool HingedVehicle::push(const LawViews& laws, Kinematics& shown) {
  return calls_.push_laws(flight_, laws, {shown.numbers(), shown.rotors.data()});
}

void HingedVehicle::show(Kinematics& k) const {
  calls_.show(flight_, {k.numbers(), k.rotors.data()});
  if (calls_.width > 1) return;  // all hinges are on the frame
  for (std::size_t i = 0; i < k.rotors.size(); ++i) {
    const std::size_t carrier = model_.carriers[rotors_[i] + 1];
    if (carrier == 0) continue;  // the carrier also turns
    const Matrix3d R_FP = k.R_WF.transpose() * R_WB(carrier);
    k.rotors.set_matrix(MotionRow::R_FR_at_zero, i, R_FP * R_PC_at_zero_[rotors_[i]]);
  }
}

Matrix3d HingedVehicle::R_WB(std::size_t i) const {
  const auto width = static_cast<std::size_t>(calls_.width);
  const double* const from = work_of(i, QUADCORE_NUMBER_OF(R_WB));
  Matrix3d R;
  for (std::size_t k = 0; k < 9; ++k) R(k / 3, k % 3) = from[k * width];
  return R;
}

GazeboStep::Multipliers HingedVehicle::multipliers(std::size_t hinge) const {
  const auto width = static_cast<std::size_t>(calls_.width);
  const auto vector = [&](std::size_t number) {
    const double* from = work_of(hinge + 1, number);
    return Vector3d(from[0], from[width], from[2 * width]);
  };
  const Vector3d f_W = vector(QUADCORE_NUMBER_OF(load_of_hinge));
  const Vector3d tau_W =
      vector(QUADCORE_NUMBER_OF(load_of_hinge) + 3) - vector(QUADCORE_NUMBER_OF(p_OA_W)).cross(f_W);
  // The axis during the step; the end of the step has rotated it.
  const Vector3d axis_W = vector(QUADCORE_NUMBER_OF(turn.direction.angular));
  const auto across_W = plane_space(axis_W);
  return {f_W.x(),          f_W.y(), f_W.z(), tau_W.dot(across_W[0]), tau_W.dot(across_W[1]),
          tau_W.dot(axis_W)};
}

Vector3d HingedVehicle::vector_of(std::size_t body, std::size_t row) const {
  const double* const from = state_of(body) + row * widest_lanes;
  return {from[0], from[widest_lanes], from[2 * widest_lanes]};
}

Vector3d HingedVehicle::position() const { return vector_of(0, BodyRow::position); }

Vector3d HingedVehicle::velocity() const { return vector_of(0, BodyRow::velocity); }

bool HingedVehicle::is_high(std::size_t i, double reach, double time, double gravity_z) const {
  const double* const rows = state_of(i);
  const double lowest = rows[(BodyRow::position + 2) * widest_lanes] - reach;
  const double* const w_WF = &state_[BodyRow::rate * widest_lanes];
  const double rate_F = Vector3d(w_WF[0], w_WF[widest_lanes], w_WF[2 * widest_lanes]).norm();
  const double fallen = std::min(0.0, gravity_z) * time * time / 2;
  // A shape moves with the body's centre of mass and turns with the frame.
  const double sinks = rows[(BodyRow::velocity + 2) * widest_lanes] - 3 * rate_F * reach;
  return lowest > 0 && lowest + fallen + time * sinks > 0;
}

}  // namespace quadcore
