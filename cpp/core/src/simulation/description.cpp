#include <algorithm>
#include <cmath>

#include "quadcore/simulation.hpp"

/// \file
/// Describes a simulation's vehicle by probing its plugins.

namespace quadcore {
namespace {

/// Speed at which rotors are probed [rad/s]. Thrust and torque per squared speed are then the
/// coefficients themselves.
constexpr double probed_rate = 1;

Wrench operator-(const Wrench& a, const Wrench& b) {
  return {a.force_F - b.force_F, a.torque_F - b.torque_F};
}

/// Part of the drag below which a coefficient is the rounding error of the probes.
constexpr double rounding = 1e-12;

/// Return the state at rest, upright at the origin.
VehicleState still(const VehicleState& state) {
  VehicleState rest;
  rest.rotor_velocity = VectorXd::Zero(state.rotor_velocity.size());
  rest.rotor_angle = VectorXd::Zero(state.rotor_angle.size());
  return rest;
}

/// Return 1 for each joint that turns: those that follow a command, or all if no plugin names them.
VectorXd turning(const VehicleDescription& vehicle) {
  VectorXd turns(static_cast<Eigen::Index>(vehicle.rotors.size()));
  for (Eigen::Index i = 0; i < turns.size(); ++i) {
    turns[i] = vehicle.rotors[static_cast<std::size_t>(i)].place == not_driven ? 0 : 1;
  }
  return turns.isZero(0) ? VectorXd::Ones(turns.size()).eval() : turns;
}

/// Return the rate [rad/s] at which the mean thrust of these joints, over both directions of
/// rotation, carries the vehicle; 0 if there is none.
double hover_rate(const VehicleDescription& vehicle, const VectorXd& turns) {
  Vector3d lift_F = Vector3d::Zero();
  for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
    const RotorDescription& rotor = vehicle.rotors[i];
    lift_F +=
        turns[static_cast<Eigen::Index>(i)] * (rotor.forward.force_F + rotor.backward.force_F) / 2;
  }
  const double weight = vehicle.body.mass * vehicle.gravity_W.norm();
  return lift_F.norm() > 0 ? std::sqrt(weight / lift_F.norm()) : 0;
}

/// Restores values at the end of a block.
class Kept {
 public:
  explicit Kept(VectorXd& numbers) : numbers_(numbers), kept_(numbers) {}
  ~Kept() { numbers_ = kept_; }
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;

 private:
  VectorXd& numbers_;
  const VectorXd kept_;
};

/// Restores an engine, with time and air velocity of its motion, at the end of a block.
class KeptEngine {
 public:
  explicit KeptEngine(Engine& engine)
      : engine_(engine),
        kept_(engine.save()),
        time_(engine.kinematics().time),
        v_WA_F_(engine.kinematics().v_WA_F) {}
  ~KeptEngine() {
    engine_.restore(kept_);
    Kinematics& motion = engine_.kinematics();
    motion.time = time_;
    motion.v_WA_F = v_WA_F_;
  }
  KeptEngine(const KeptEngine&) = delete;
  KeptEngine& operator=(const KeptEngine&) = delete;

 private:
  Engine& engine_;
  const std::vector<double> kept_;
  const double time_;
  const Vector3d v_WA_F_;
};

}  // namespace

void Simulation::prepare_plugins() {
  const auto asks = [](const LoadedPlugin& p) { return p.descriptor->create.hooks.prepare; };
  if (std::none_of(plugins_.begin(), plugins_.end(), asks)) return;
  const VehicleDescription vehicle = probe_vehicle();
  for (const LoadedPlugin& p : plugins_) {
    if (!asks(p)) continue;
    active_ = &p;
    p.plugin->prepare(vehicle);
  }
  active_ = nullptr;
}

const VehicleDescription& Simulation::describe_vehicle() {
  if (!description_) description_ = probe_vehicle();
  return *description_;
}

VehicleDescription Simulation::probe_vehicle() {
  const KeptEngine as_it_is(*engine_);
  // Use the initial plugin state: later changes of it are not part of the vehicle.
  const Kept state_of_plugins(plugin_state_);
  plugin_state_.setZero();
  const Model& flown = engine_->model();
  VehicleDescription vehicle{mass_properties(flown), world_.gravity_W, {}, {}};
  const std::vector<Eigen::Isometry3d> poses = link_poses(flown);
  const VehicleState rest = still(state_);
  const Wrench resting = probe(rest);
  for (std::size_t i = 0; i < flown.joints.size(); ++i) {
    const Eigen::Isometry3d& pose = poses[i + 1];
    const auto turning = [&](double rate) {
      VehicleState state = rest;
      state.rotor_velocity[static_cast<Eigen::Index>(i)] = rate;
      return probe(state) - resting;
    };
    RotorDescription rotor;
    rotor.joint = flown.joints[i].name;
    rotor.p_FR_F = pose.translation();
    rotor.p_FRcm_F = pose * flown.links[i + 1].inertial.pose.xyz;
    rotor.axis_F = pose.linear() * flown.joints[i].axis;
    rotor.moment = moment_about_joint(flown, i);
    rotor.forward = turning(probed_rate);
    rotor.backward = turning(-probed_rate);
    vehicle.rotors.push_back(rotor);
  }
  for (const LoadedPlugin& p : plugins_) p.plugin->describe_rotors(vehicle.rotors);
  for (RotorDescription& rotor : vehicle.rotors) {
    const double slowed = std::abs(rotor.rate_per_command);
    if (rotor.slowdown == 0) rotor.slowdown = slowed > 0 ? 1 / slowed : 1;
  }
  vehicle.air = probe_air(vehicle);
  return vehicle;
}

/// Return force and torque about the vehicle's centre of mass in a state, in still air.
Wrench Simulation::probe(const VehicleState& state) {
  engine_->set_state(state);
  Kinematics& k = engine_->kinematics();
  k.v_WA_F.setZero();
  Loads loads(k.rotors.size());
  push(with_.forces, k, loads);
  Wrench sum = loads.frame();
  for (std::size_t i = 0; i < k.rotors.size(); ++i) {
    const Vector3d f_F = loads.rotor_force_F(i);
    sum.force_F += f_F;
    sum.torque_F += k.rotors[i].p_FRcm_F.cross(f_F);
  }
  sum.torque_F -= k.p_FCcm_F.cross(sum.force_F);
  return sum;
}

AirResistance Simulation::probe_air(const VehicleDescription& vehicle) {
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  VehicleState state = still(state_);
  const VectorXd turns = turning(vehicle);
  const double hover = hover_rate(vehicle, turns);
  // The part of the wrench that changes sign with the velocity, averaged over quarter turns and
  // both directions of the rotors.
  const auto odd = [&](const Vector6d& velocity) {
    Vector6d sum = Vector6d::Zero();
    for (int quarter = 0; quarter < 4; ++quarter) {
      state.rotor_angle.setConstant(std::remainder(quarter * M_PI / 2, 2 * M_PI));
      for (const double rate : {hover, -hover}) {
        state.rotor_velocity = rate * turns;
        for (const double sign : {1.0, -1.0}) {
          state.angular_velocity = sign * velocity.tail<3>();
          state.linear_velocity =
              sign * velocity.head<3>() - state.angular_velocity.cross(vehicle.body.p_FCcm);
          const Wrench wrench = probe(state);
          sum.head<3>() += sign / 16 * wrench.force_F;
          sum.tail<3>() += sign / 16 * wrench.torque_F;
        }
      }
    }
    return sum;
  };
  AirResistance air;
  Vector3d along_axes;  // quadratic + of_components
  for (int i = 0; i < 6; ++i) {
    const Vector6d slow = odd(Vector6d::Unit(i)), fast = odd(2 * Vector6d::Unit(i));
    air.linear.col(i) = -(2 * slow - fast / 2);  // f(v) = -(linear v + squared |v| v)
    if (i < 3) along_axes[i] = -(fast[i] - 2 * slow[i]) / 2;
  }
  Vector6d diagonal;
  diagonal << 1, 1, 1, 0, 0, 0;
  const Vector3d across_axes =
      -(odd(diagonal) + air.linear * diagonal).head<3>();  // sqrt(3) quadratic + of_components
  const double drag = std::max(air.linear.cwiseAbs().maxCoeff(), along_axes.cwiseAbs().maxCoeff());
  const double quadratic = (across_axes - along_axes).mean() / (std::sqrt(3.0) - 1);
  air.quadratic = std::abs(quadratic) > rounding * drag ? quadratic : 0;
  air.of_components = along_axes - Vector3d::Constant(air.quadratic);
  return air;
}

}  // namespace quadcore
