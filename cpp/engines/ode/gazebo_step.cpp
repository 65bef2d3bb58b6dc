#include "gazebo_step.hpp"

#include <algorithm>
#include <cmath>

#include "body_damping.hpp"
#include "body_state.hpp"
#include "ode_math.hpp"
#include "quadcore/plugin/random.hpp"

namespace quadcore {
namespace {

// Measured in Gazebo 11.1.
constexpr double warm_start_factor = 0.5;
constexpr double friction_relaxation = 0.25;  ///< of a friction row, in addition to the world's
constexpr int friction_sweeps = 10;           ///< over the friction rows alone, at the end
constexpr double contact_smoothing =
    0.01;  ///< of contact multipliers in the solution for velocities

constexpr int sweeps_per_test = 8;  ///< between tests of the convergence, which cost a sweep each

constexpr int pose = 0, velocity = 1;  ///< indices of the two solutions

bool is_capped(const ConstraintRow& row) { return std::abs(row.correction) > row.max_correction; }

}  // namespace

GazeboStep::GazeboStep(const std::vector<dBodyID>& bodies, std::vector<Hinge> hinges,
                       const std::vector<std::size_t>& order, const Options& options,
                       std::size_t vehicle)
    : warm_start(hinges.size()),
      asleep(bodies.size()),
      unmoved(bodies.size(), dInfinity),
      ode_bodies_(bodies),
      constraints_(bodies, std::move(hinges), order, options.rows),
      options_(options),
      bodies_(bodies.size()),
      vehicle_(vehicle) {
  sweeps_.bodies.resize(bodies.size());
  sweeps_.smoothing = Sweeps::Two{0, contact_smoothing};
  const std::vector<Hinge>& all = constraints_.hinges();
  const auto is_simple = [&](const Hinge& hinge) {
    return options.rows.cfm == 0 && hinge.friction == 0 && hinge.implicit_damping == 0;
  };
  const auto last = std::find_if(all.begin(), all.end(),
                                 [&](const Hinge& hinge) { return hinge.child >= vehicle; });
  if (std::all_of(all.begin(), last, is_simple)) {
    simple_hinges_ = static_cast<std::size_t>(last - all.begin());
  }
  reserve(0);
}

void GazeboStep::reserve(std::size_t contacts) {
  constraints_.reserve(contacts);
  sweeps_.hinges.reserve(warm_start.size());
  sweeps_.rows.reserve(constraints_.most_rows());
  sweeps_.order.reserve(constraints_.most_rows());
  solved_.reserve(constraints_.most_rows());
  place_.reserve(constraints_.most_rows());
  prepared_.reserve(constraints_.most_rows());
}

void GazeboStep::step(const std::vector<Contact>& contacts, double dt, const BodyRange& range) {
  rows_ = &constraints_.build(contacts, dt, range, asleep);
  read_bodies(range);
  prepare_rows();
  begin(dt);
  sweeps_.sweep(options_.iterations);
  sweeps_.sweep_rows(friction_sweeps, friction_begin_);
  for (std::size_t i = 0; i < rows_->size(); ++i) {
    const ConstraintRow& row = (*rows_)[i];
    if (row.hinge < 0) continue;
    WarmStart& start = warm_start[static_cast<std::size_t>(row.hinge)];
    const auto k = static_cast<std::size_t>(row.hinge_row);
    start.pose[k] = solved_[i]->multiplier[pose];
    start.velocity[k] = solved_[i]->multiplier[velocity];
  }
  for (std::size_t i = range.begin; i < range.end; ++i) {
    Body& b = bodies_[i];
    b.moving = b.velocity + dt * (b.free_acceleration + constraint(i, pose));
    b.velocity += dt * (b.free_acceleration + constraint(i, velocity));
  }
  damp(range);
  move(dt, range);
}

void GazeboStep::read_bodies(const BodyRange& range) {
  for (std::size_t i = range.begin; i < range.end; ++i) {
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

GazeboStep::Vector6 GazeboStep::inverse_mass_J(const ConstraintRow& row, int side) const {
  const Body& body = bodies_[static_cast<std::size_t>(row.body[side])];
  Vector6 result;
  result << body.inverse_mass * row.J[side].head<3>(),
      body.inverse_inertia_W * row.J[side].tail<3>();
  return result;
}

/// Fill the sweeps with the rows.
void GazeboStep::prepare_rows() {
  sweeps_.hinges.clear();
  sweeps_.rows.clear();
  solved_.clear();
  place_.clear();
  prepared_.clear();
  for (std::size_t i = 0; i < rows_->size(); ++i) {
    const ConstraintRow& row = (*rows_)[i];
    Prepared& prepared = prepared_.emplace_back();
    double diagonal = row.cfm;
    for (int side = 0; side < 2 && row.body[side] >= 0; ++side) {
      prepared.inverse_mass_J[side] = inverse_mass_J(row, side);
      diagonal += row.J[side].dot(prepared.inverse_mass_J[side]);
    }
    prepared.relaxation = options_.sor * (row.normal >= 0 ? friction_relaxation : 1.0) / diagonal;
    if (row.hinge >= 0 && static_cast<std::size_t>(row.hinge) < simple_hinges_) {
      put_hinge(i);
    } else {
      put_row(i);
    }
  }
  order_rows();
}

void GazeboStep::put_hinge(std::size_t index) {
  const ConstraintRow& row = (*rows_)[index];
  const Prepared& prepared = prepared_[index];
  if (row.hinge_row == 0) {
    const bool locked = constraints_.hinges()[static_cast<std::size_t>(row.hinge)].locked;
    sweeps_.hinges.push_back({row.body[0], row.body[1], locked, {}});
  }
  const auto k = static_cast<std::size_t>(row.hinge_row);
  Sweeps::HingeRow& to = sweeps_.hinges.back().rows[k];
  const Vector6 &of_C = prepared.inverse_mass_J[0], &of_P = prepared.inverse_mass_J[1];
  for (int j = 0; j < 3; ++j) {
    to.turn_C[j] = row.J[0][3 + j];
    to.turn_P[j] = row.J[1][3 + j];
    to.angular_C[j] = of_C[3 + j];
    to.angular_P[j] = of_P[3 + j];
  }
  to.linear_C = row.hinge_row < 3 ? of_C[row.hinge_row] : 0;
  to.linear_P = row.hinge_row < 3 ? of_P[row.hinge_row] : 0;
  to.relaxation = prepared.relaxation;
  solved_.push_back(&to);
  place_.push_back(-1);
}

void GazeboStep::put_row(std::size_t index) {
  const ConstraintRow& row = (*rows_)[index];
  const Prepared& prepared = prepared_[index];
  Sweeps::Row to;
  for (int side = 0; side < 2; ++side) {
    to.body[side] = row.body[side];
    if (row.body[side] < 0) continue;
    Eigen::Map<Vector6>(to.J[side]) = row.J[side];
    Eigen::Map<Vector6>(to.inverse_mass_J[side]) = prepared.inverse_mass_J[side];
  }
  to.relaxation = prepared.relaxation;
  to.cfm = row.cfm;
  to.low = row.low;
  to.high = row.high;
  to.friction = row.friction;
  to.normal = row.normal < 0 ? -1 : place_[static_cast<std::size_t>(row.normal)];
  to.smooth = row.hinge < 0;
  place_.push_back(static_cast<int>(sweeps_.rows.size()));
  sweeps_.rows.push_back(to);
  solved_.push_back(&sweeps_.rows.back());
}

/// Hinges in row order, normals in reverse, friction in row order.
void GazeboStep::order_rows() {
  const auto& rows = *rows_;
  std::vector<std::size_t>& order = sweeps_.order;
  const auto put = [&](std::size_t i) { order.push_back(static_cast<std::size_t>(place_[i])); };
  order.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].hinge >= 0 && place_[i] >= 0) put(i);
  }
  for (std::size_t i = rows.size(); i-- > 0;) {
    if (rows[i].hinge < 0 && rows[i].normal < 0) put(i);
  }
  friction_begin_ = order.size();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].normal >= 0) put(i);
  }
}

void GazeboStep::add_multiplier(std::size_t index, const Sweeps::Two& multiplier) {
  const ConstraintRow& row = (*rows_)[index];
  for (int side = 0; side < 2 && row.body[side] >= 0; ++side) {
    const Vector6& by = prepared_[index].inverse_mass_J[side];
    Sweeps::Acceleration& sum = sweeps_.bodies[static_cast<std::size_t>(row.body[side])];
    for (std::size_t k = 0; k < 6; ++k) sum[k] += multiplier * by[static_cast<int>(k)];
  }
}

bool GazeboStep::caps_hinges(double dt) {
  const std::vector<ConstraintRow>& rows = constraints_.build({}, dt, vehicle(), asleep);
  return std::any_of(rows.begin(), rows.end(), is_capped);
}

/// Initialise both solutions.
void GazeboStep::begin(double dt) {
  for (Sweeps::Acceleration& body : sweeps_.bodies) body.fill(Sweeps::Two{});
  for (std::size_t i = 0; i < rows_->size(); ++i) {
    const ConstraintRow& row = (*rows_)[i];
    Sweeps::Two multiplier{};
    if (row.hinge >= 0) {
      const WarmStart& start = warm_start[static_cast<std::size_t>(row.hinge)];
      const auto k = static_cast<std::size_t>(row.hinge_row);
      multiplier =
          Sweeps::Two{warm_start_factor * start.pose[k], warm_start_factor * start.velocity[k]};
    }
    // Gazebo loses the sign of limited values.
    const double kept = is_capped(row) ? row.max_correction : row.correction;
    Sweeps::Two wanted{row.correction / dt, kept / dt};
    for (int side = 0; side < 2 && row.body[side] >= 0; ++side) {
      const Body& body = bodies_[static_cast<std::size_t>(row.body[side])];
      wanted -= row.J[side].dot(body.velocity / dt + body.free_acceleration);
    }
    solved_[i]->multiplier = multiplier;
    solved_[i]->wanted = wanted;
    add_multiplier(i, multiplier);
  }
}

/// Return the acceleration of a body by the constraints.
GazeboStep::Vector6 GazeboStep::constraint(std::size_t body, int solve) const {
  Vector6 a;
  for (std::size_t k = 0; k < 6; ++k) a[static_cast<int>(k)] = sweeps_.bodies[body][k][solve];
  return a;
}

double GazeboStep::remaining_error(double dt, std::uint64_t seed, double enough) {
  static const std::vector<Contact> none;
  read_bodies(vehicle());
  rows_ = &constraints_.build(none, dt, vehicle(), asleep);
  prepare_rows();
  for (Sweeps::Acceleration& body : sweeps_.bodies) body.fill(Sweeps::Two{});
  double count = 0;
  for (std::size_t i = 0; i < rows_->size(); ++i) {
    // In units of the multiplier that alone would stop the row's bodies.
    const double multiplier = random_normal(seed, count) * std::sqrt(prepared_[i].relaxation);
    solved_[i]->multiplier = Sweeps::Two{multiplier, multiplier};
    solved_[i]->wanted = Sweeps::Two{};
    add_multiplier(i, solved_[i]->multiplier);
  }
  const auto energy = [this] {
    double sum = 0;
    for (std::size_t i = 0; i < rows_->size(); ++i) {
      const ConstraintRow& row = (*rows_)[i];
      const double multiplier = solved_[i]->multiplier[pose];
      double acceleration = row.cfm * multiplier;
      for (int side = 0; side < 2 && row.body[side] >= 0; ++side) {
        acceleration += row.J[side].dot(constraint(static_cast<std::size_t>(row.body[side]), pose));
      }
      sum += multiplier * acceleration;
    }
    return sum;
  };
  const double first = energy();
  double part = 1;
  // More sweeps only reduce the energy: it decreases with each row that is relaxed.
  for (int left = options_.iterations; left > 0 && part > enough; left -= sweeps_per_test) {
    sweeps_.sweep(std::min(left, sweeps_per_test));
    part = std::sqrt(std::abs(energy() / first));
  }
  return part;
}

/// Gazebo damps the velocity that moves a pose, including the correction of a penetration, and
/// subtracts the difference from the velocity.
void GazeboStep::damp(const BodyRange& range) {
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const Damping& damping = options_.damping[i];
    if (damping.linear == 0 && damping.angular == 0) continue;
    Body& b = bodies_[i];
    Vector6 damped;
    damped << part_left_by_damping(b.moving.head<3>(), damping.linear) * b.moving.head<3>(),
        part_left_by_damping(b.moving.tail<3>(), damping.angular) * b.moving.tail<3>();
    b.velocity = damped + (b.velocity - b.moving);
  }
}

void GazeboStep::move(double dt, const BodyRange& range) {
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const dBodyID ode = ode_bodies_[i];
    unmoved[i] = asleep[i] ? unmoved[i] + 1 : 0;
    if (asleep[i]) {
      forget_forces(ode);
      continue;
    }
    const Body& body = bodies_[i];
    move_pose(ode, body.moving.head<3>(), body.moving.tail<3>(), dt);
    restore_velocity(ode, body.velocity.data());
    forget_forces(ode);
  }
}

}  // namespace quadcore
