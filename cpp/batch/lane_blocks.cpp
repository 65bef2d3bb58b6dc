#include "lane_blocks.hpp"

#include <algorithm>

#include "hinged_block.hpp"
#include "lanes/for_each_width.hpp"
#include "laws/motor_target.hpp"
#include "ode/body_work.hpp"
#include "ode/ode_engine.hpp"
#include "quadcore/lane_width.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::batch {
namespace {

/// Limits within which a vehicle is certainly not diverged; beyond them, its Simulation decides.
constexpr double sure_distance = 1e8;                      // m
constexpr double sure_speed = 1e5;                         // m/s
constexpr double sure_rate = Simulation::max_rate / 10.0;  // rad/s

double square(double a) { return a * a; }

}  // namespace

LaneBlocks::LaneBlocks(const std::vector<std::shared_ptr<const LaneVehicle>>& vehicles,
                       std::size_t rotors, const World& world)
    : rotors_(rotors), gravity_W_(world.gravity_W), constants_differ_(false) {
  const LaneVehicle* first = nullptr;
  bounds_ = {unbounded,
             false,
             world.ground_plane,
             -unbounded,
             square(sure_distance),
             square(sure_speed),
             square(sure_rate)};
  for (const auto& vehicle : vehicles) {
    if (!vehicle) continue;
    if (!first) {
      first = vehicle.get();
      laws_ = first->laws;
    }
    constants_differ_ |= vehicle->constants != first->constants;
    laws_.acting |= vehicle->laws.acting;
    laws_.drag |= vehicle->laws.drag;
    laws_.airframe |= vehicle->laws.airframe;
    laws_.aligned &= vehicle->laws.aligned;
    bounds_.fastest = std::min(bounds_.fastest, vehicle->fastest);
    bounds_.no_tilt |= vehicle->no_tilt;
    bounds_.reach = std::max(bounds_.reach, vehicle->reach);
  }
  const std::size_t places = (vehicles.size() + widest_lanes - 1) / widest_lanes * widest_lanes;
  flies_.resize(places);
  if (!first) return;
  places_ = first->places;
  hinged_ = first->hinged;
  if (are_hinged()) {
    tree_ = hinged_->tree(world, world.contact_max_correcting_vel);
    has_contact_ = world.ground_plane || !world.obstacles.empty();
    if (has_contact_) of_contact_.resize(vehicles.size());
  }
  choose_width();

  const std::size_t rows = constant_rows();
  constants_.resize(rows * (constants_differ_ ? places : widest_lanes));
  state_.resize(state_rows() * places);
  motors_.resize(MotorRow::count * rotors * places);
  if (!world.obstacles.empty()) clear_balls_.emplace(world.obstacles, places, bounds_.reach);
  may_spin_.resize(places);
  may_tilt_.resize(places);
  for (std::size_t i = 0; i < places; ++i) {
    const bool is_in = i < vehicles.size() && vehicles[i];
    const LaneVehicle& vehicle = is_in ? *vehicles[i] : *first;  // unused places are simulated, too
    flies_[i] = -std::int64_t{is_in};
    if (!are_hinged()) {
      column(state_, state_rows(), i)[(StateRow::orientation + 3) * widest_lanes] = 1;
    }
    if (!constants_differ_ && i >= widest_lanes) continue;
    double* constants = column(constants_, rows, i);
    for (std::size_t row = 0; row < rows; ++row) {
      constants[row * widest_lanes] = vehicle.constants[row];
    }
  }
}

void LaneBlocks::choose_width() {
  using Step = void(const Block&, std::int64_t, double);
  using Show = void(const Block&, double*);
  static constexpr laws::ForEachWidth<Step> steps{&step_block<1>, &step_block<2>, &step_block<4>,
                                                  &step_block<8>};
  static constexpr laws::ForEachWidth<Show> shows{&show_block<1>, &show_block<2>, &show_block<4>,
                                                  &show_block<8>};
  static constexpr laws::ForEachWidth<Step> hinged_steps{
      &step_hinged_block<1>, &step_hinged_block<2>, &step_hinged_block<4>, &step_hinged_block<8>};
  static constexpr laws::ForEachWidth<Show> hinged_shows{
      &show_hinged_block<1>, &show_hinged_block<2>, &show_hinged_block<4>, &show_hinged_block<8>};
  static constexpr laws::ForEachWidth<void(const Block&, const int*, const Commands&)> commands{
      &command_motors<1>, &command_motors<2>, &command_motors<4>, &command_motors<8>};
  const int width = lane_width();
  command_ = commands[width];
  step_ = are_hinged() ? hinged_steps[width] : steps[width];
  show_ = are_hinged() ? hinged_shows[width] : shows[width];
}

std::size_t LaneBlocks::state_rows() const {
  return are_hinged() ? HingedRow::state(rotors_) : StateRow::count(rotors_);
}

std::size_t LaneBlocks::constant_rows() const {
  return are_hinged() ? HingedRow::constants(rotors_) : ConstantRow::count(rotors_);
}

std::size_t LaneBlocks::work_size() const {
  if (!are_hinged()) return batch::work_size(rotors_);
  constexpr std::size_t of_body =
      (sizeof(BodyWork<double>) + sizeof(SoftRows<double>)) / sizeof(double);
  return (TurnedRow::end(rotors_) + (rotors_ + 1) * of_body) * widest_lanes;
}

void LaneBlocks::begin(std::size_t vehicle, const std::vector<double>& engine_state) {
  set_engine_state(vehicle, engine_state);
  let_fly(vehicle, true);
  may_spin_[vehicle] = may_tilt_[vehicle] = 0;
  double* motors = column(motors_, MotorRow::count * rotors_, vehicle);
  for (std::size_t i = 0; i < rotors_; ++i) {
    motors[(i * MotorRow::count + MotorRow::active) * widest_lanes] = 0;
  }
}

void LaneBlocks::lift_bounds(std::size_t vehicle, const std::vector<Quiet>& quiet) {
  const bool spins =
      std::none_of(quiet.begin(), quiet.end(), [](const Quiet& of) { return of.bounds_rates(); });
  const bool tilts =
      std::none_of(quiet.begin(), quiet.end(), [](const Quiet& of) { return of.bounds_tilt(); });
  may_spin_[vehicle] |= -std::int64_t{spins};
  may_tilt_[vehicle] |= -std::int64_t{tilts};
}

void LaneBlocks::command(std::size_t vehicle, const double* speeds) {
  if (is_empty()) return;
  double* motors = column(motors_, MotorRow::count * rotors_, vehicle);
  const double* constants = constants_of(vehicle);
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

void LaneBlocks::command(std::size_t block, const Commands& commands) {
  if (!is_empty()) command_(view(block, nullptr, nullptr), places_.data(), commands);
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
          part(constants_, constants_differ_ ? constant_rows() : 0),
          part(motors_, MotorRow::count * rotors_),
          &flies_[first],
          &may_spin_[first],
          &may_tilt_[first],
          clear_balls_ ? clear_balls_->of_block(block) : nullptr,
          part(state_, state_rows()),
          work,
          steps,
          &tree_};
}

void LaneBlocks::step(std::size_t block, std::int64_t count, double dt, double* work,
                      std::int64_t* steps, double* variation) {
  std::fill_n(steps, widest_lanes, 0);
  if (is_empty()) return;
  Block stepped = view(block, work, steps);
  stepped.variation = variation;
  do {
    step_(stepped, count, dt);
  } while (clear_balls_ && move_clear_balls(block, count, steps));
}

/// Move the clear balls of the vehicles that have stopped to their positions. Returns whether a
/// ball has moved, so that its vehicle may continue.
bool LaneBlocks::move_clear_balls(std::size_t block, std::int64_t count,
                                  const std::int64_t* steps) {
  static_assert(StateRow::position == 0 && BodyRow::position == 0, "both begin a state");
  bool has_moved = false;
  for (std::size_t lane = 0; lane < widest_lanes; ++lane) {
    const std::size_t vehicle = block * widest_lanes + lane;
    if (!flies(vehicle) || steps[lane] == count) continue;
    has_moved |= clear_balls_->move(vehicle, column(state_, state_rows(), vehicle));
  }
  return has_moved;
}

void LaneBlocks::show(std::size_t block, double* work) {
  if (!is_empty()) show_(view(block, work, nullptr), work);
}

void LaneBlocks::show(std::size_t block, std::size_t vehicles, double* work, double* rows) {
  if (is_empty()) return;
  show(block, work);
  const std::size_t width = shown_rows();
  for (std::size_t i = 0; i < vehicles; ++i) {
    double* to = rows + i * width;
    for (std::size_t row = 0; row < StateRow::joints; ++row) to[row] = work[row * widest_lanes + i];
    for (std::size_t j = 0; j < rotors_; ++j) {
      const auto joint = [&](std::size_t row) {
        return work[StateRow::joint(row, j) * widest_lanes + i];
      };
      to[StateRow::joints + j] = joint(StateRow::joint_rate);
      to[StateRow::joints + rotors_ + j] = are_hinged()
                                               ? hinged_angle(block * widest_lanes + i, work + i, j)
                                               : joint(StateRow::joint_angle);
    }
  }
}

/// Return the angle of the j-th joint of a vehicle with a written motion, like Kinematics::angle().
double LaneBlocks::hinged_angle(std::size_t vehicle, const double* shown, std::size_t j) const {
  const auto vector = [](const double* from) {
    return Vector3d(from[0], from[widest_lanes], from[2 * widest_lanes]);
  };
  const auto matrix = [&](const double* from) {
    Matrix3d m;
    m << vector(from), vector(from + 3 * widest_lanes), vector(from + 6 * widest_lanes);
    return m;
  };
  const double* const rotor = shown + TurnedRow::rotor(0, j, rotors_) * widest_lanes;
  const double* const at_zero =
      constants_of(vehicle) + ConstantRow::rotor(ConstantRow::R_FR_at_zero, j) * widest_lanes;
  const Matrix3d R = matrix(rotor + TurnedRow::R_FR * widest_lanes) * matrix(at_zero).transpose();
  const Vector3d twice_sine(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  return elementary::atan2(vector(rotor + TurnedRow::axis_F * widest_lanes).dot(twice_sine),
                           R.trace() - 1);
}

void LaneBlocks::let_fly(std::size_t vehicle, bool flies) {
  flies_[vehicle] = -std::int64_t{flies};
  if (has_contact_ && !is_clear_of_contact(of_contact_[vehicle])) flies_[vehicle] = 0;
}

}  // namespace quadcore::batch
