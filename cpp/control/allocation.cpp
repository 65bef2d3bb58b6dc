#include "quadcore/control/allocation.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "actuation_formulas.hpp"
#include "numbers.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::control {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Keeps the sums below finite; a flight counts as diverged at this speed.
constexpr double largest_square = Simulation::max_rate * Simulation::max_rate;

/// Return a vector orthogonal to three vectors of four numbers.
Eigen::Vector4d orthogonal(const Eigen::Matrix<double, 4, 3>& vectors) {
  Eigen::Vector4d normal;
  for (int i = 0; i < 4; ++i) {
    Matrix3d minor;
    for (int row = 0; row < 3; ++row) minor.row(row) = vectors.row(row < i ? row : row + 1);
    normal[i] = (i % 2 == 0 ? 1 : -1) * minor.determinant();
  }
  return normal;
}

/// Return the sum of the numbers of all rotors, each multiplied by its remaining fraction.
double left_of(const VectorXd& numbers, const double* lost) {
  double sum = 0;
  for (Eigen::Index i = 0; i < numbers.size(); ++i) sum += (1 - lost[i]) * numbers[i];
  return sum;
}

}  // namespace

/// Numbers of each rotor.
struct Allocation::Numbers {
  std::vector<AllocatedRotor<double>> rotors;
};

const AllocatedRotor<double>& Allocation::rotor(std::size_t i) const { return numbers_->rotors[i]; }

Allocation::Allocation(const ModelledVehicle& model) {
  const Eigen::Index n = model.effectiveness.cols();
  // Force along z, then the torques.
  const Eigen::Matrix<double, 4, Eigen::Dynamic> effect = model.effectiveness.bottomRows<4>();
  inverse_.resize(n, 4);
  // Scaled such that thrust and torques have the same magnitude, which makes the rank well defined.
  size_ = effect.rowwise().norm();
  const bool spans = n >= 4 && (size_.array() > 0).all();
  if (spans) {
    scaled_ = size_.cwiseInverse().asDiagonal() * effect;
    const Eigen::Matrix4d squared = scaled_ * scaled_.transpose();
    const Eigen::Vector4d singular = squared.jacobiSvd().singularValues();
    if (singular[3] > 1e-9 * singular[0]) {
      inverse_ = scaled_.transpose() * squared.inverse() * size_.cwiseInverse().asDiagonal();
      least_.resize(n);
      most_.resize(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        const ModelledRotor& rotor = model.rotors[static_cast<std::size_t>(i)];
        least_[i] = rotor.slowest * rotor.slowest;
        most_[i] = std::min(rotor.fastest * rotor.fastest, largest_square);
      }
      nothing_.setZero(n);
      find_facets();
      auto numbers = std::make_shared<Numbers>();
      for (Eigen::Index i = 0; i < n; ++i) {
        AllocatedRotor<double> rotor{least_[i], most_[i], {}, {}};
        for (Eigen::Index k = 0; k < 4; ++k) {
          rotor.inverse[k] = inverse_(i, k);
          rotor.effect[k] = effect(k, i);
        }
        numbers->rotors.push_back(rotor);
      }
      numbers_ = std::move(numbers);
      return;
    }
  }
  throw InputError(
      "the rotors cannot produce thrust and the torques about all axes independently. Add rotors "
      "or force laws, or give spins with opposite signs.");
}

void Allocation::find_facets() {
  const Eigen::Index n = scaled_.cols();
  const Eigen::Matrix4Xd directions = scaled_.colwise().normalized();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = i + 1; j < n; ++j) {
      Eigen::Matrix<double, 4, 3> plane;
      plane << directions.col(i), directions.col(j), Eigen::Vector4d::UnitW();
      add_facets(level_, orthogonal(plane));
      for (Eigen::Index k = j + 1; n > 4 && k < n; ++k) {
        plane.col(2) = directions.col(k);
        add_facets(facets_, orthogonal(plane));
      }
    }
  }
  for (int i = 0; n == 4 && i < n; ++i) {  // limits of each rotor
    facets_.push_back(
        {inverse_.row(i), least_[i] * VectorXd::Unit(n, i), most_[i] * VectorXd::Unit(n, i)});
  }
}

void Allocation::add_facets(std::vector<Facets>& facets, Eigen::Vector4d scaled_normal) const {
  constexpr double parallel = 1e-6, rounding = 1e-10;
  if (scaled_normal.norm() < parallel) return;  // the rotors span no facet
  scaled_normal.normalize();
  scaled_normal = (scaled_normal.array().abs() < rounding).select(0, scaled_normal);
  Facets made{scaled_normal.cwiseQuotient(size_), nothing_, nothing_};
  for (Eigen::Index l = 0; l < scaled_.cols(); ++l) {
    const double along = scaled_normal.dot(scaled_.col(l));
    if (std::abs(along) < rounding * scaled_.col(l).norm()) continue;  // l lies in the plane
    made.least[l] = along * (along > 0 ? least_[l] : most_[l]);
    made.most[l] = along * (along > 0 ? most_[l] : least_[l]);
  }
  facets.push_back(made);
}

bool Allocation::allocate(const Demand& demand, double* squares, const double* lost) const {
  const Eigen::Index n = inverse_.rows();
  if (!lost) lost = nothing_.data();
  const DemandNumbers<double> wanted{demand.thrust, numbers_of(demand.torque_F)};
  for (std::size_t i = 0; i < rotors(); ++i) squares[i] = square_for(rotor(i), wanted);
  bool met = fits(squares, lost);
  Eigen::Map<VectorXd> u(squares, n);
  Eigen::Vector4d whole;
  whole << demand.thrust, demand.torque_F;
  if (!met && n > 4 && is_within(whole, lost)) {
    redistribute(whole, squares, lost);
    met = true;
  } else if (!met) {
    const bool at_any_yaw = std::any_of(lost, lost + n, [](double share) { return share > 0; });
    const Share share = fit(demand, lost, at_any_yaw);
    u = demand.torque_F.x() * inverse_.col(1) + demand.torque_F.y() * inverse_.col(2);
    u = share.roll_pitch * u + share.thrust * inverse_.col(0);
    u += share.yaw * inverse_.col(3);
    if (n > 4 && !fits(squares, lost)) {
      whole << share.thrust, share.roll_pitch * demand.torque_F;
      whole[3] = share.yaw;
      redistribute(whole, squares, lost);
    }
    met = at_any_yaw && share.roll_pitch == 1 && share.thrust == demand.thrust;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const double left = 1 - lost[i];
    u[i] = left > 0 ? std::clamp(u[i] / left, least_[i], most_[i]) : least_[i];
  }
  return met;
}

bool Allocation::fits(const double* squares, const double* lost) const {
  for (std::size_t i = 0; i < rotors(); ++i) {
    if (!is_allowed(rotor(i), squares[i], 1 - lost[i])) return false;
  }
  return true;
}

bool Allocation::is_within(const Eigen::Vector4d& demand, const double* lost) const {
  const double rounding = 1e-9 * demand.cwiseQuotient(size_).norm();
  return std::all_of(facets_.begin(), facets_.end(), [&](const Facets& f) {
    const double at = f.normal.dot(demand);
    return at >= left_of(f.least, lost) - rounding && at <= left_of(f.most, lost) + rounding;
  });
}

/// The attainable demands form a zonotope, see the class. Demands of a fraction of the roll and
/// pitch torques with any thrust form a plane through it. In this plane, two parallel facets are
/// two parallel lines that bound the thrust from below and above; together they enclose a convex
/// polygon. Its maximum fraction is at a corner, where a lower line rises above an upper one. There
/// are few facets, so every pair of lines is tried.
Allocation::Share Allocation::fit(const Demand& demand, const double* lost, bool at_any_yaw) const {
  struct Line {
    double thrust, slope;  // at a fraction of 0; change with the fraction
    double at(double share) const { return thrust + share * slope; }
  };
  struct Bounds {
    Line lower, upper;
  };
  const std::vector<Facets>& facets = at_any_yaw ? level_ : facets_;
  Share share{1, 0, 0};
  static thread_local std::vector<Bounds> bounds;  // kept, because steps allocate no memory
  bounds.clear();
  for (const Facets& pair : facets) {
    const double lift = pair.normal[0];
    const double torque =
        demand.torque_F.x() * pair.normal[1] + demand.torque_F.y() * pair.normal[2];
    const double least = left_of(pair.least, lost), most = left_of(pair.most, lost);
    if (lift != 0) {
      const Line at_least{least / lift, -torque / lift}, at_most{most / lift, -torque / lift};
      bounds.push_back(lift > 0 ? Bounds{at_least, at_most} : Bounds{at_most, at_least});
    } else if (torque != 0) {  // independent of the thrust
      share.roll_pitch = std::clamp((torque > 0 ? most : least) / torque, 0.0, share.roll_pitch);
    }
  }
  for (const Bounds& one : bounds) {
    for (const Bounds& other : bounds) {
      const Line &lower = one.lower, &upper = other.upper;
      if (lower.slope <= upper.slope) continue;
      const double meeting = (upper.thrust - lower.thrust) / (lower.slope - upper.slope);
      share.roll_pitch = std::clamp(meeting, 0.0, share.roll_pitch);
    }
  }
  double least = -infinity, most = infinity;
  for (const auto& [lower, upper] : bounds) {
    least = std::max(least, lower.at(share.roll_pitch));
    most = std::min(most, upper.at(share.roll_pitch));
  }
  // At a corner the two bounds are equal up to rounding.
  share.thrust = std::max(least, std::min(demand.thrust, most));
  const auto [low, high] = yaw_beside(share.thrust, share.roll_pitch * demand.torque_F.x(),
                                      share.roll_pitch * demand.torque_F.y(), lost);
  share.yaw = std::max(low, std::min(demand.torque_F.z(), high));
  return share;
}

Allocation::Interval Allocation::yaw_beside(double thrust, double roll, double pitch,
                                            const double* lost) const {
  Interval yaw{-infinity, infinity};
  for (const Facets& f : facets_) {
    if (f.normal[3] == 0) continue;
    const double at = thrust * f.normal[0] + roll * f.normal[1] + pitch * f.normal[2];
    const double one = (left_of(f.least, lost) - at) / f.normal[3];
    const double other = (left_of(f.most, lost) - at) / f.normal[3];
    yaw.least = std::max(yaw.least, std::min(one, other));
    yaw.most = std::min(yaw.most, std::max(one, other));
  }
  return yaw;
}

bool Allocation::can_control_yaw(double thrust, const double* lost) const {
  constexpr double share = 0.01;  // minimum torque in one direction relative to the other
  const auto [least, most] = yaw_beside(thrust, 0, 0, lost);
  return std::min(-least, most) > share * std::max(-least, most);
}

/// The least squares are clamp(B^T x) for the x that maximises a concave function (the dual), whose
/// gradient is the unmet part of the demand. It is found by Newton's method with a line search. A
/// small `give` keeps the problem well posed if too few rotors are off their limits.
void Allocation::redistribute(const Eigen::Vector4d& demand, double* squares,
                              const double* lost) const {
  constexpr double give = 1e-14, close = 1e-12;
  constexpr int rounds = 60, halvings = 60;
  const Eigen::Vector4d wanted = demand.cwiseQuotient(size_);
  /// Return the unmet part of the demand at x and store the squares.
  const auto missing = [&](const Eigen::Vector4d& x) {
    Eigen::Vector4d rest = wanted - give * x;
    for (Eigen::Index i = 0; i < scaled_.cols(); ++i) {
      const double left = 1 - lost[i];
      squares[i] = std::clamp(scaled_.col(i).dot(x), left * least_[i], left * most_[i]);
      rest -= squares[i] * scaled_.col(i);
    }
    return rest;
  };
  Eigen::Vector4d x = Eigen::Vector4d::Zero(), rest = missing(x);
  for (int round = 0; round < rounds && rest.norm() > close * wanted.norm(); ++round) {
    Eigen::Matrix4d slope = give * Eigen::Matrix4d::Identity();
    for (Eigen::Index i = 0; i < scaled_.cols(); ++i) {
      const double free = scaled_.col(i).dot(x), left = 1 - lost[i];
      const bool moves = round == 0 || (free >= left * least_[i] && free <= left * most_[i]);
      if (moves) slope += scaled_.col(i) * scaled_.col(i).transpose();
    }
    const Eigen::Vector4d step = slope.ldlt().solve(rest);
    double from = 0, to = 1;
    if (step.dot(missing(x + step)) < 0) {
      for (int halving = 0; halving < halvings; ++halving) {
        const double middle = (from + to) / 2;
        (step.dot(missing(x + middle * step)) > 0 ? from : to) = middle;
      }
    }
    x += to * step;
    rest = missing(x);
  }
}

Demand Allocation::exerted(const double* squares, const double* lost) const {
  if (!lost) lost = nothing_.data();
  DemandNumbers<double> sum{};
  for (std::size_t i = 0; i < rotors(); ++i) add_wrench(rotor(i), squares[i], 1 - lost[i], sum);
  return demand_of(sum);
}

}  // namespace quadcore::control
