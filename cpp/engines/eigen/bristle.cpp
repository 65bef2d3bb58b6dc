#include "bristle.hpp"

#include <algorithm>
#include <cmath>

#include "contact_stiffness.hpp"

namespace quadcore {
namespace {

/// Coefficients of the classical Runge-Kutta method: weight of each stage's rate in the sum, and
/// distance from the start of the step to the next stage, as a fraction of the step.
constexpr double weights[] = {1, 2, 2, 1}, reaches[] = {0.5, 0.5, 1, 0};

}  // namespace

Spring make_spring(double stable, double hardest, double dt) {
  const double stiffness = std::min(stable / (dt * dt), hardest);
  const double relaxation = largest_damping_per_step / largest_square_per_step * dt;
  return {stiffness, relaxation * std::sqrt(stable / (stiffness * dt * dt))};
}

void Bristle::begin(const Spring& spring) {
  spring_ = spring;
  bent_ = bristle_;
  sum_.setZero();
}

PatchResistance Bristle::resist(const PressedPatch& patch, const Vector3d& v, const Vector3d& w,
                                int stage, double dt) {
  const double arm = laws::rolling_resistance * patch.reach;
  const double radius = std::sqrt(patch.square / patch.pressing + arm * arm);
  const double lever = laws::rolling_lever * patch.reach;
  const double length = patch.direction.head<2>().norm();
  axis_ = length > 0 ? (patch.direction.head<2>() / length).eval() : Eigen::Vector2d(0, -1);
  force_ = patch.pressing;
  friction_ = patch.friction;
  Bent rate;
  rate << v.x(), v.y(), radius * w.z(), lever * w.x(), lever * w.y();
  const Bent resistance = rub(rate, stage, dt);
  return {{resistance[0], resistance[1], 0},
          {lever * resistance[3], lever * resistance[4], radius * resistance[2]}};
}

void Bristle::release(int stage, double dt) {
  force_ = 0;
  friction_.setZero();
  rub(Bent::Zero(), stage, dt);
}

/// Return the resistance with the bristle moving at a rate [m/s].
Bristle::Bent Bristle::rub(const Bent& rate, int stage, double dt) {
  const auto& [stiffness, relaxation] = spring_;
  const Bent resistance = limit(-stiffness * (bent_ + relaxation * rate));
  sum_ += weights[stage] * rate;
  bent_ = bristle_ + reaches[stage] * dt * rate;
  return resistance;
}

/// Limit a resistance by friction, in the axes of the friction.
Bristle::Bent Bristle::limit(const Bent& wanted_N) const {
  const double x = axis_.x(), y = axis_.y();
  Bent wanted = wanted_N;
  wanted[0] = x * wanted_N[0] + y * wanted_N[1];
  wanted[1] = x * wanted_N[1] - y * wanted_N[0];
  const Bent possible = laws::possible(friction_, force_, wanted);
  Bent possible_N = possible;
  possible_N[0] = x * possible[0] - y * possible[1];
  possible_N[1] = y * possible[0] + x * possible[1];
  return possible_N;
}

void Bristle::end(double dt) {
  const Bent bent = bristle_ + dt / 6 * sum_;
  bristle_ = limit(spring_.stiffness * bent) / spring_.stiffness;
}

double* Bristle::save(double* to) const {
  return std::copy(bristle_.data(), bristle_.data() + saved_size, to);
}

const double* Bristle::restore(const double* from) {
  std::copy(from, from + saved_size, bristle_.data());
  return from + saved_size;
}

}  // namespace quadcore
