#include "eigen_engine.hpp"

#include <algorithm>
#include <cmath>

#include "lanes/for_each_width.hpp"
#include "laws/rotor_forces.hpp"
#include "quadcore/lane_width.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore {
namespace {

/// Reject settings that only an engine with separate bodies can model.
void refuse_tags(const Model& model) {
  const auto refuse = [](const std::string& where, const std::string& what) {
    throw InputError(
        where + ": " + what +
        ", which the engine eigen does not model. Remove it, or use the engine ode or gazebo11.");
  };
  for (const Link& link : model.links) {
    if (!link.tags.gravity) refuse(link.tags.where, "link '" + link.name + "' has no gravity");
    if (link.tags.damping_factor > 0) {
      refuse(link.tags.where, "link '" + link.name + "' has a <dampingFactor>");
    }
  }
  for (const Joint& joint : model.joints) {
    if (joint.friction > 0) refuse(joint.where, "joint '" + joint.name + "' has friction");
  }
}

void refuse_free_bodies(const World& world) {
  if (world.free_bodies.empty()) return;
  const FreeBody& first = world.free_bodies.front();
  throw InputError(first.where + ": the engine eigen does not model the free body '" + first.model +
                   "'. Use the engine ode or gazebo11.");
}

/// Return warnings about tags of Gazebo's solver that have no effect in contact here.
std::vector<std::string> list_unused_tags(const Model& model) {
  std::vector<std::string> all;
  const Surface usual;
  for (const Link& link : model.links) {
    for (const Collision& collision : link.collisions) {
      const Surface& surface = collision.surface;
      if (surface.kd == usual.kd && surface.min_depth == usual.min_depth &&
          surface.max_vel == usual.max_vel && surface.max_contacts == usual.max_contacts) {
        continue;
      }
      all.push_back(
          collision.where +
          ": the engine eigen ignores <kd>, <minDepth>, <maxVel> and <maxContacts> of this "
          "shape. Use the engine ode or gazebo11 to include them.");
    }
  }
  return all;
}

/// Return a warning about tags of obstacles that have no effect here, if some have them.
std::vector<std::string> list_unused_tags(const std::vector<Obstacle>& obstacles) {
  const Obstacle* first = nullptr;
  int count = 0;
  for (const Obstacle& obstacle : obstacles) {
    if (obstacle.slip1 == 0 && obstacle.slip2 == 0 && obstacle.restitution == 0) continue;
    if (!first) first = &obstacle;
    ++count;
  }
  if (!first) return {};
  const std::string others =
      count > 1 ? " and " + std::to_string(count - 1) + " more obstacles" : "";
  return {first->where + ": the engine eigen ignores <slip1>, <slip2> and <bounce> of '" +
          first->model + "'" + others + ". Use the engine ode or gazebo11 to include them."};
}

/// Numbers of substeps in contact, where impacts are faster than all other motion. Obstacles may be
/// thin, and the vehicle must not pass through them.
constexpr int parts_at_ground = 4, parts_at_obstacle = 16;

}  // namespace

EigenEngine::EigenEngine(const Model& model, const World& world)
    : model_(with_round_rotors(model, warnings_)),
      body_(model_),
      gravity_W_(world.gravity_W),
      kinematics_(model.joints.size(), false),
      loads_(model.joints.size()),
      state_(GyrostatState::joints +
             RotorRows<GyrostatState::joint_rows>::size_of(model.joints.size())),
      stage_(state_),
      sum_(state_),
      joint_torques_(RotorRows<1>::size_of(model.joints.size())),
      turns_(RotorRows<TurnRow::count>::size_of(model.joints.size())),
      given_rates_(model.joints.size()),
      reacting_(model.joints.size()) {
  refuse_tags(model_);
  refuse_free_bodies(world);
  if (!world.obstacles.empty()) {
    obstacles_.emplace(model_, body_, world.obstacles);
    for (const std::string& unused : list_unused_tags(world.obstacles)) warnings_.push_back(unused);
  }
  if (world.ground_plane) ground_.emplace(model_, body_, world.ground);
  kinematics_.p_FCcm_F = body_.p_FCcm_F;
  RotorMotions& rotors = kinematics_.rotors;
  for (std::size_t i = 0; i < rotors.size(); ++i) {
    const Matrix3d& R_FR = body_.R_FR_at_zero[i];
    const Vector3d axis_F = body_.rotors.vector(RotorConstant::axis_F, i);
    rotors.set_vector(MotionRow::axis, i, axis_F);
    rotors.set_vector(MotionRow::normal, i, R_FR.col(2));
    rotors.set_vector(MotionRow::p_FRcm, i, body_.p_FRcm_F[i]);
    rotors.set_matrix(MotionRow::R_FR_at_zero, i, R_FR);
  }
  static constexpr laws::ForEachWidth<void(const GyrostatStep&, const double*)> shows{
      &show_gyrostat<1>, &show_gyrostat<2>, &show_gyrostat<4>, &show_gyrostat<8>};
  static constexpr laws::ForEachWidth<void(const GyrostatStep&, double, double)> steps{
      &step_gyrostat<1>, &step_gyrostat<2>, &step_gyrostat<4>, &step_gyrostat<8>};
  const int width = lane_width();
  show_ = shows[width];
  advance_ = steps[width];
  step_ = view();
  state_[GyrostatState::orientation + 3] = 1;
  show();
}

GyrostatStep EigenEngine::view() {
  Kinematics& k = kinematics_;
  GyrostatStep g;
  g.rotors = k.rotors.size();
  g.constants = body_.rotors.data();
  g.normals_turn = body_.normals_turn;
  g.upright = body_.upright;
  g.inverse_mass = body_.inverse_mass;
  const auto copy = [](const Vector3d& from, double (&to)[4]) {
    std::copy(from.data(), from.data() + 3, to);
    to[3] = 0;
  };
  copy(body_.p_FCcm_F, g.p_FCcm_F);
  copy(gravity_W_, g.gravity_W);
  const auto copy_columns = [](const Matrix3d& from, double (&to)[3][4]) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) to[j][i] = from(i, j);
      to[j][3] = 0;
    }
  };
  copy_columns(body_.I_Ccm_F, g.I_C_F);
  copy_columns(body_.inverse_reduced_I_F, g.inverse_reduced_I_F);
  g.state = state_.data();
  g.stage = stage_.data();
  g.sum = sum_.data();
  g.joint_torques = joint_torques_.data();
  g.turns = turns_.data();
  g.frame = k.numbers();
  g.motion = k.rotors.data();
  g.loads = loads_.rotors().data();
  g.frame_force_F = loads_.on_frame().force_F.data();
  g.frame_torque_F = loads_.on_frame().torque_F.data();
  g.given_rates = nullptr;
  g.laws_turn = false;
  g.laws = {};
  g.evaluate_rest = nullptr;
  g.refuse = [](void* engine) { static_cast<EigenEngine*>(engine)->refuse(); };
  g.engine = this;
  return g;
}

void EigenEngine::step(double time, double dt, const ForceField& forces) {
  forces_ = &forces;
  const ForceLaws& force_laws = forces.laws();
  step_.laws = views_of(force_laws);
  step_.laws_turn = step_.normals_turn;
  for (const RotorForces& law : force_laws.rotor_forces) {
    step_.laws_turn |= (law.acting & laws::in_link_axes) != 0;
  }
  step_.evaluate_rest = nullptr;
  if (!force_laws.complete) {
    step_.evaluate_rest = [](void* engine) { static_cast<EigenEngine*>(engine)->evaluate_rest(); };
  }
  touches_obstacles_ = obstacles_ && is_at_obstacle(dt);
  if (touches_obstacles_ || (ground_ && is_at_ground(dt))) {
    step_in_contact(time, dt, touches_obstacles_ ? parts_at_obstacle : parts_at_ground);
  } else {
    advance_(step_, time, dt);
  }
  if (loads_.any_rate()) end_given_rates();
}

bool EigenEngine::is_at_ground(double dt) const {
  constexpr std::size_t z = 2;
  return ground_->is_near(state_[GyrostatState::position + z], state_[GyrostatState::velocity + z],
                          dt) &&
         ground_->is_ahead(kinematics_, dt);
}

bool EigenEngine::is_at_obstacle(double dt) {
  const Eigen::Map<const Vector3d> p_WC(state_.data() + GyrostatState::position);
  const Eigen::Map<const Vector3d> v_WC(state_.data() + GyrostatState::velocity);
  return obstacles_->is_near(p_WC, v_WC.norm(), dt) && obstacles_->is_ahead(kinematics_, dt);
}

void EigenEngine::step_in_contact(double time, double dt, int parts) {
  const double part = dt / parts;
  if (placed_ && ground_) ground_->refuse_deep(kinematics_, part);
  if (placed_ && touches_obstacles_) obstacles_->refuse_deep(kinematics_, part);
  placed_ = false;
  step_.evaluate_rest = [](void* engine) {
    EigenEngine& self = *static_cast<EigenEngine*>(engine);
    if (self.forces_->laws().complete) {
      self.loads_.clear_rest();
    } else {
      self.evaluate_rest();
    }
    if (self.ground_) self.ground_->add_forces(self.kinematics_, self.loads_);
    if (self.touches_obstacles_) self.obstacles_->add_forces(self.kinematics_, self.loads_);
  };
  for (int i = 0; i < parts; ++i) {
    if (ground_) ground_->begin(part);
    if (touches_obstacles_) obstacles_->begin(part);
    advance_(step_, time + i * part, part);
    if (ground_) ground_->end();
    if (touches_obstacles_) obstacles_->end();
  }
}

void EigenEngine::evaluate_rest() {
  loads_.clear_rest();
  forces_->evaluate_rest(kinematics_, loads_);
  take_given_rates();
}

/// A rotor with a prescribed rate turns with the frame. The frame takes the torque for this only if
/// the rate reacts; then the rotor is part of the frame about its axis.
void EigenEngine::take_given_rates() {
  step_.given_rates = loads_.any_rate() ? given_rates_.data() : nullptr;
  const bool any_reacted = std::find(reacting_.begin(), reacting_.end(), true) != reacting_.end();
  if (!loads_.any_rate() && !any_reacted) return;
  bool changed = false;
  for (std::size_t i = 0; i < reacting_.size(); ++i) {
    const auto& rate = loads_.joint_rate(i);
    const bool reacts = rate && rate->reacts;
    given_rates_.number(GivenRateRow::free, i) = rate ? 0 : 1;
    given_rates_.number(GivenRateRow::slope, i) = rate ? rate->slope : 0;
    given_rates_.number(GivenRateRow::torque, i) =
        reacts ? body_.rotors.number(RotorConstant::moment, i) * rate->slope : 0;
    changed |= reacts != reacting_[i];
    reacting_[i] = reacts;
  }
  if (!changed) return;
  const Matrix3d inverse_I_F = body_.inverse_inertia_with(reacting_);
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) step_.inverse_reduced_I_F[j][i] = inverse_I_F(i, j);
  }
}

/// At the end of a step, set prescribed rates exactly instead of integrating their slopes.
void EigenEngine::end_given_rates() {
  for (std::size_t i = 0; i < reacting_.size(); ++i) {
    const auto& rate = loads_.joint_rate(i);
    if (!rate) continue;
    state_[GyrostatState::joints + rotor_offset(GyrostatState::joint_rows, i) +
           GyrostatState::joint_rate * widest_lanes] = rate->at_end;
    kinematics_.rotors.number(MotionRow::rate, i) = rate->at_end;
  }
}

void EigenEngine::refuse() { forces_->refuse(kinematics_, loads_); }

void EigenEngine::show() { show_(step_, state_.data()); }

void EigenEngine::set_state(const VehicleState& state) {
  const Quaterniond q = state.orientation.normalized();
  const auto put = [&](std::size_t at, const auto& values) {
    std::copy(values.data(), values.data() + values.size(), state_.data() + at);
  };
  const Vector3d p_WCcm = state.position + q * body_.p_FCcm_F;
  const Vector3d v_WCcm_W =
      state.linear_velocity + q * state.angular_velocity.cross(body_.p_FCcm_F);
  put(GyrostatState::position, p_WCcm);
  put(GyrostatState::orientation, q.coeffs());
  put(GyrostatState::velocity, v_WCcm_W);
  put(GyrostatState::rate, state.angular_velocity);
  for (std::size_t i = 0; i < kinematics_.rotors.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    double* joint =
        state_.data() + GyrostatState::joints + rotor_offset(GyrostatState::joint_rows, i);
    joint[GyrostatState::joint_rate * widest_lanes] = state.rotor_velocity[row];
    joint[GyrostatState::joint_angle * widest_lanes] =
        std::remainder(state.rotor_angle[row], 2 * M_PI);
  }
  if (ground_) ground_->clear();
  if (obstacles_) obstacles_->clear();
  placed_ = true;
  show();
}

std::string EigenEngine::method() const {
  std::string method = "classical fourth-order Runge-Kutta on the reduced equations of motion";
  if (ground_) {
    method += "; approximate ground contact by springs, dampers and bristles in " +
              std::to_string(parts_at_ground) + " substeps";
  }
  if (obstacles_) {
    method += "; approximate contact with obstacles likewise in " +
              std::to_string(parts_at_obstacle) + " substeps";
  }
  return method;
}

std::vector<std::string> EigenEngine::warnings() const {
  std::vector<std::string> warnings = warnings_;
  if (!ground_ && !obstacles_) return warnings;
  const std::vector<std::string> of_contact = list_unused_tags(model_);
  warnings.insert(warnings.end(), of_contact.begin(), of_contact.end());
  return warnings;
}

/// Return the size of save(); only contact has a memory beyond the state.
std::size_t EigenEngine::saved_size() const {
  if (!ground_ && !obstacles_) return state_.size();
  return state_.size() + (ground_ ? ground_->saved_size() : 0) +
         (obstacles_ ? obstacles_->saved_size() : 0) + 1;
}

std::vector<double> EigenEngine::save() const {
  std::vector<double> saved(state_.begin(), state_.end());
  if (!ground_ && !obstacles_) return saved;
  saved.resize(saved_size());
  double* to = saved.data() + state_.size();
  if (ground_) to = ground_->save(to);
  if (obstacles_) to = obstacles_->save(to);
  *to = placed_;
  return saved;
}

void EigenEngine::restore(const std::vector<double>& saved) {
  if (saved.size() != saved_size()) {
    throw InputError(
        "snapshot: it was taken with another model or engine. Restore a snapshot of this "
        "simulation.");
  }
  const auto from = saved.begin() + static_cast<std::ptrdiff_t>(state_.size());
  std::copy(saved.begin(), from, state_.begin());
  if (ground_ || obstacles_) {
    const double* rest = &*from;
    if (ground_) rest = ground_->restore(rest);
    if (obstacles_) rest = obstacles_->restore(rest);
    placed_ = *rest != 0;
  }
  show();
}

}  // namespace quadcore
