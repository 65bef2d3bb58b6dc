#include "gazebo_step.hpp"

#include <algorithm>
#include <cmath>

#include "body_state.hpp"
#include "ode_math.hpp"
#include "quadcore/random.hpp"

namespace quadcore {
namespace {

// Measured in Gazebo 11.1.
constexpr double warm_start_factor = 0.5;
constexpr double friction_relaxation = 0.25;  ///< of a friction row, on top of the world's
constexpr int friction_sweeps = 10;           ///< over the friction rows alone, at the end
constexpr double contact_smoothing = 0.01;  ///< of contact multipliers, where velocities are solved

}  // namespace

GazeboStep::GazeboStep(const std::vector<dBodyID>& bodies, std::vector<Hinge> hinges,
                       const std::vector<std::size_t>& order, const Options& options)
    : warm_start(hinges.size()),
      ode_bodies_(bodies),
      constraints_(bodies, std::move(hinges), order, options.rows),
      options_(options),
      bodies_(bodies.size()) {
  hinge_sweeps_.hinges.resize(warm_start.size());
}

void GazeboStep::reserve(std::size_t contacts) {
  constraints_.reserve(contacts);
  sweeps_.reserve(constraints_.most_rows());
  order_.reserve(constraints_.most_rows());
}

void GazeboStep::step(const std::vector<Contact>& contacts, double dt) {
  read_bodies();
  rows_ = &constraints_.build(contacts, dt);
  order_rows();
  prepare_rows();
  const bool once = is_solved_once();
  solve(&WarmStart::pose, false, 0, dt);
  for (Body& b : bodies_) b.moving = b.velocity + dt * (b.free_acceleration + b.constraint);
  if (once) {
    for (WarmStart& start : warm_start) start.velocity = start.pose;
  } else {
    solve(&WarmStart::velocity, true, contact_smoothing, dt);
  }
  for (Body& b : bodies_) b.velocity += dt * (b.free_acceleration + b.constraint);
  move(dt);
}

void GazeboStep::read_bodies() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const dBodyID ode = ode_bodies_[i];
    Body& body = bodies_[i];
    dMass mass;
    dBodyGetMass(ode, &mass);
    const Matrix3d R_WB = rotation(dBodyGetRotation(ode));
    body.inverse_mass = 1 / mass.mass;
    body.inverse_inertia_W = R_WB * rotation(mass.I).inverse() * R_WB.transpose();
    body.velocity << vec(dBodyGetLinearVel(ode)), vec(dBodyGetAngularVel(ode));
    body.free_acceleration << body.inverse_mass * vec(dBodyGetForce(ode)),
        body.inverse_inertia_W * vec(dBodyGetTorque(ode));
    if (dBodyGetGravityMode(ode)) body.free_acceleration.head<3>() += options_.gravity_W;
  }
}

/// Hinges in row order, normals in reverse, friction in row order.
void GazeboStep::order_rows() {
  const auto& rows = *rows_;
  order_.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].hinge >= 0) order_.push_back(i);
  }
  for (std::size_t i = rows.size(); i-- > 0;) {
    if (rows[i].hinge < 0 && rows[i].normal < 0) order_.push_back(i);
  }
  friction_begin_ = order_.size();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].normal >= 0) order_.push_back(i);
  }
}

void GazeboStep::prepare_rows() {
  sweeps_.resize(rows_->size());
  for (std::size_t i = 0; i < rows_->size(); ++i) {
    const ConstraintRow& row = (*rows_)[i];
    Sweep& sweep = sweeps_[i];
    double diagonal = row.cfm;
    for (int side = 0; side < 2 && row.body[side] >= 0; ++side) {
      const Body& body = bodies_[static_cast<std::size_t>(row.body[side])];
      sweep.inverse_mass_J[side] << body.inverse_mass * row.J[side].head<3>(),
          body.inverse_inertia_W * row.J[side].tail<3>();
      diagonal += row.J[side].dot(sweep.inverse_mass_J[side]);
    }
    sweep.relaxation = options_.sor * (row.normal >= 0 ? friction_relaxation : 1.0) / diagonal;
  }
}

void GazeboStep::solve(Multipliers WarmStart::* start, bool cap, double smoothing, double dt) {
  const auto& rows = *rows_;
  const auto remembered = [&](const ConstraintRow& row) -> double& {
    return (warm_start[static_cast<std::size_t>(row.hinge)].*
            start)[static_cast<std::size_t>(row.hinge_row)];
  };
  for (Body& body : bodies_) body.constraint.setZero();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ConstraintRow& row = rows[i];
    Sweep& sweep = sweeps_[i];
    sweep.multiplier = row.hinge < 0 ? 0 : warm_start_factor * remembered(row);
    // Gazebo forgets the sign of what it caps.
    const bool capped = cap && std::abs(row.correction) > row.max_correction;
    sweep.wanted = (capped ? row.max_correction : row.correction) / dt;
    for (int side = 0; side < 2 && row.body[side] >= 0; ++side) {
      Body& body = bodies_[static_cast<std::size_t>(row.body[side])];
      sweep.wanted -= row.J[side].dot(body.velocity / dt + body.free_acceleration);
      body.constraint += sweep.multiplier * sweep.inverse_mass_J[side];
    }
  }
  if (are_hinges_alone()) {
    sweep_hinges();
  } else {
    for (int n = 0; n < options_.iterations; ++n) {
      for (const std::size_t row : order_) relax(row, smoothing);
    }
    for (int n = 0; n < friction_sweeps; ++n) {
      for (std::size_t k = friction_begin_; k < order_.size(); ++k) relax(order_[k], smoothing);
    }
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].hinge >= 0) remembered(rows[i]) = sweeps_[i].multiplier;
  }
}

/// Whether HingeSweeps may take the place of the sweeps.
bool GazeboStep::are_hinges_alone() const {
  return options_.rows.cfm == 0 && rows_->size() == HingeSweeps::rows_of_hinge * warm_start.size();
}

/// Whether poses and velocities have one solution: there is nothing but hinges, no correction is
/// capped, and both start from the same multipliers.
bool GazeboStep::is_solved_once() const {
  return are_hinges_alone() &&
         std::all_of(rows_->begin(), rows_->end(),
                     [](const ConstraintRow& row) {
                       return std::abs(row.correction) <= row.max_correction;
                     }) &&
         std::all_of(warm_start.begin(), warm_start.end(),
                     [](const WarmStart& start) { return start.pose == start.velocity; });
}

void GazeboStep::sweep_hinges() {
  const auto& rows = *rows_;
  std::size_t i = 0;
  for (HingeSweeps::HingeRows& hinge : hinge_sweeps_.hinges) {
    hinge.child = &bodies_[static_cast<std::size_t>(rows[i].body[0])].constraint;
    hinge.parent = &bodies_[static_cast<std::size_t>(rows[i].body[1])].constraint;
    for (HingeSweeps::Row& to : hinge.rows) {
      const ConstraintRow& row = rows[i];
      const Sweep& from = sweeps_[i++];
      to.turn_C = row.J[0].tail<3>();
      to.turn_P = row.J[1].tail<3>();
      to.angular_C = from.inverse_mass_J[0].tail<3>();
      to.angular_P = from.inverse_mass_J[1].tail<3>();
      if (row.hinge_row < 3) {
        to.linear_C = from.inverse_mass_J[0][row.hinge_row];
        to.linear_P = from.inverse_mass_J[1][row.hinge_row];
      }
      to.relaxation = from.relaxation;
      to.wanted = from.wanted;
      to.multiplier = from.multiplier;
    }
  }
  hinge_sweeps_.sweep(options_.iterations);
  i = 0;
  for (const HingeSweeps::HingeRows& hinge : hinge_sweeps_.hinges) {
    for (const HingeSweeps::Row& from : hinge.rows) sweeps_[i++].multiplier = from.multiplier;
  }
}

double GazeboStep::remaining_error(double dt, std::uint64_t seed) {
  static const std::vector<Contact> none;
  read_bodies();
  rows_ = &constraints_.build(none, dt);
  order_rows();
  prepare_rows();
  for (Body& body : bodies_) body.constraint.setZero();
  double count = 0;
  for (std::size_t i = 0; i < rows_->size(); ++i) {
    const ConstraintRow& row = (*rows_)[i];
    Sweep& sweep = sweeps_[i];
    // In units of the multiplier that would stop the row's bodies by itself.
    sweep.multiplier = random_normal(seed, count) * std::sqrt(sweep.relaxation);
    sweep.wanted = 0;
    for (int side = 0; side < 2 && row.body[side] >= 0; ++side) {
      bodies_[static_cast<std::size_t>(row.body[side])].constraint +=
          sweep.multiplier * sweep.inverse_mass_J[side];
    }
  }
  const auto energy = [this] {
    double sum = 0;
    for (std::size_t i = 0; i < rows_->size(); ++i) {
      const ConstraintRow& row = (*rows_)[i];
      double acceleration = row.cfm * sweeps_[i].multiplier;
      for (int side = 0; side < 2 && row.body[side] >= 0; ++side) {
        acceleration +=
            row.J[side].dot(bodies_[static_cast<std::size_t>(row.body[side])].constraint);
      }
      sum += sweeps_[i].multiplier * acceleration;
    }
    return sum;
  };
  const double first = energy();
  double part = 1;
  for (int n = 0; n < options_.iterations && part > 1e-16; ++n) {
    for (const std::size_t row : order_) relax(row, 0);
    part = std::sqrt(std::abs(energy() / first));
  }
  return part;
}

void GazeboStep::relax(std::size_t index, double smoothing) {
  const ConstraintRow& row = (*rows_)[index];
  Sweep& sweep = sweeps_[index];
  double residual = sweep.wanted - row.cfm * sweep.multiplier;
  for (int side = 0; side < 2 && row.body[side] >= 0; ++side) {
    residual -= row.J[side].dot(bodies_[static_cast<std::size_t>(row.body[side])].constraint);
  }
  double low = row.low, high = row.high;
  if (row.normal >= 0) {
    high = row.friction * sweeps_[static_cast<std::size_t>(row.normal)].multiplier;
    low = -high;
  }
  const double old = sweep.multiplier;
  const double next = std::clamp(old + sweep.relaxation * residual, low, high);
  for (int side = 0; side < 2 && row.body[side] >= 0; ++side) {
    bodies_[static_cast<std::size_t>(row.body[side])].constraint +=
        (next - old) * sweep.inverse_mass_J[side];
  }
  // Gazebo smooths contact multipliers after it has applied them.
  sweep.multiplier = row.hinge < 0 ? (1 - smoothing) * next + smoothing * old : next;
}

void GazeboStep::move(double dt) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const dBodyID ode = ode_bodies_[i];
    const Body& body = bodies_[i];
    move_pose(ode, body.moving.head<3>(), body.moving.tail<3>(), dt);
    restore_velocity(ode, body.velocity.data());
    forget_forces(ode);
  }
}

}  // namespace quadcore
