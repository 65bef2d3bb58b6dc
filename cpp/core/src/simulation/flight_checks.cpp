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

/// Beyond these no flight is meant; the numbers only say "diverged" before they overflow.
constexpr double max_rate = Simulation::max_rate;  // rad/s
constexpr double max_speed = 1e6;                  // m/s
constexpr double max_distance = 1e9;               // m
constexpr double max_time = 1e9;  // s; far beyond, a step no longer moves the clock

/// Throws InputError on a size at which is_sane() calls the motion diverged.
void refuse_diverged(const char* what, double size, double limit, const char* unit) {
  if (size < limit) return;
  std::ostringstream message;
  message.imbue(std::locale::classic());
  message << what << " is " << size << ' ' << unit << ", but a flight counts as diverged from "
          << limit << ' ' << unit << " on. Give a smaller one.";
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
  // Comparisons are written so that NaN fails them.
  return k.p_WF.squaredNorm() < max_distance * max_distance && k.q_WF.squaredNorm() < 2 &&
         k.v_WF_F.squaredNorm() < max_speed * max_speed &&
         k.w_WF_F.squaredNorm() < max_rate * max_rate && k.rotors.slower_than(max_rate);
}

void check_snapshot(const Snapshot& snapshot, Eigen::Index plugin_state) {
  constexpr std::int64_t most_steps = std::int64_t{1} << 53;  // all of which a double tells apart
  const auto is_finite = [](double number) { return std::isfinite(number); };
  const std::vector<double>& engine = snapshot.engine;
  const bool flies = snapshot.failure.empty();  // a motion that failed may hold anything
  const bool good = snapshot.taken_from && snapshot.plugin_state.size() == plugin_state &&
                    std::abs(snapshot.start_time) <= max_time && snapshot.steps >= 0 &&
                    snapshot.steps <= most_steps &&
                    (!flies || std::all_of(engine.begin(), engine.end(), is_finite));
  if (!good) throw InputError("snapshot: is damaged; take it anew");
}

void check_state(const VehicleState& state, Eigen::Index rotors) {
  if (state.rotor_velocity.size() != rotors || state.rotor_angle.size() != rotors) {
    throw InputError("state: this vehicle has " + std::to_string(rotors) +
                     " rotors; give as many velocities and angles");
  }
  if (!std::isfinite(state.time) || !state.position.allFinite() ||
      !state.orientation.coeffs().allFinite() || !state.linear_velocity.allFinite() ||
      !state.angular_velocity.allFinite() || !state.rotor_velocity.allFinite() ||
      !state.rotor_angle.allFinite()) {
    throw InputError("state: a value is not a finite number");
  }
  if (std::abs(state.time) > max_time) {
    throw InputError("state: the time is beyond 1e9 s; give the seconds since the flight began");
  }
  if (!(state.orientation.norm() > 1e-6)) {
    throw InputError("state: the orientation is no quaternion; give a unit (x, y, z, w)");
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
    throw InputError("spawn holds a number that is not finite; write x,y,z[,roll,pitch,yaw]");
  }
  refuse_diverged("spawn: the distance from the origin", spawn.xyz.norm(), max_distance, "m");
}

}  // namespace quadcore
