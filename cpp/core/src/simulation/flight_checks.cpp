#include "flight_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <locale>
#include <sstream>
#include <string>

#include "quadcore/plugin/error.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore {
namespace {

/// Limits at which a flight counts as diverged, far beyond any real flight but before overflow.
constexpr double max_rate = Simulation::max_rate;  // rad/s
constexpr double max_speed = 1e6;                  // m/s
constexpr double max_distance = 1e9;               // m
constexpr double max_time = 1e9;  // s; far beyond it, a step no longer changes the time

/// Throw InputError for a magnitude at which is_sane() counts the motion as diverged.
void refuse_diverged(const char* what, double size, double limit, const char* unit) {
  if (size < limit) return;
  std::ostringstream message;
  message.imbue(std::locale::classic());
  message << what << " is " << size << ' ' << unit << ", but a flight counts as diverged from "
          << limit << ' ' << unit << ". Give a smaller value.";
  throw InputError(message.str());
}

}  // namespace

bool is_finite(const Kinematics& k) {
  double rates = 0;
  for (std::size_t i = 0; i < k.rotors.size(); ++i) rates += k.rotors.number(MotionRow::rate, i);
  return k.p_WF.allFinite() && k.q_WF.coeffs().allFinite() && k.v_WF_F.allFinite() &&
         k.w_WF_F.allFinite() && std::isfinite(rates);
}

bool is_sane(const Kinematics& k) {
  // The comparisons are written such that NaN fails them.
  return k.p_WF.squaredNorm() < max_distance * max_distance && k.q_WF.squaredNorm() < 2 &&
         k.v_WF_F.squaredNorm() < max_speed * max_speed &&
         k.w_WF_F.squaredNorm() < max_rate * max_rate && k.rotors.slower_than(max_rate);
}

void check_snapshot(const Snapshot& snapshot, Eigen::Index plugin_state) {
  constexpr std::int64_t most_steps = std::int64_t{1}
                                      << 53;  // a double represents all of them exactly
  const auto is_finite = [](double number) { return std::isfinite(number); };
  const std::vector<double>& engine = snapshot.engine;
  const bool flies = snapshot.failure.empty();  // a failed motion may contain any values
  const bool good = snapshot.taken_from && snapshot.plugin_state.size() == plugin_state &&
                    std::abs(snapshot.start_time) <= max_time && snapshot.steps >= 0 &&
                    snapshot.steps <= most_steps &&
                    (!flies || std::all_of(engine.begin(), engine.end(), is_finite));
  if (!good) throw InputError("snapshot: it is damaged. Take a new snapshot.");
}

void check_state(const VehicleState& state, Eigen::Index rotors) {
  if (state.rotor_velocity.size() != rotors || state.rotor_angle.size() != rotors) {
    throw InputError("state: this vehicle has " + std::to_string(rotors) +
                     " rotors. Give as many velocities and angles.");
  }
  if (!std::isfinite(state.time) || !state.position.allFinite() ||
      !state.orientation.coeffs().allFinite() || !state.linear_velocity.allFinite() ||
      !state.angular_velocity.allFinite() || !state.rotor_velocity.allFinite() ||
      !state.rotor_angle.allFinite()) {
    throw InputError("state: a value is not a finite number. Give finite numbers.");
  }
  if (std::abs(state.time) > max_time) {
    throw InputError(
        "state: the time is beyond 1e9 s. Give the time since the start of the flight in s.");
  }
  if (!(state.orientation.norm() > 1e-6)) {
    throw InputError(
        "state: the orientation is not a unit quaternion. Give (x, y, z, w) of length 1.");
  }
  refuse_diverged("state: the distance from the origin", state.position.norm(), max_distance, "m");
  refuse_diverged("state: the velocity", state.linear_velocity.norm(), max_speed, "m/s");
  refuse_diverged("state: the angular velocity", state.angular_velocity.norm(), max_rate, "rad/s");
  for (Eigen::Index i = 0; i < rotors; ++i) {
    const double rate = std::abs(state.rotor_velocity[i]);
    refuse_diverged("state: the velocity of a rotor", rate, max_rate, "rad/s");
  }
}

void check_spawn(const Pose& spawn) {
  if (!spawn.xyz.allFinite() || !spawn.rpy.allFinite()) {
    throw InputError("spawn: a value is not a finite number. Write x,y,z[,roll,pitch,yaw].");
  }
  refuse_diverged("spawn: the distance from the origin", spawn.xyz.norm(), max_distance, "m");
}

}  // namespace quadcore
