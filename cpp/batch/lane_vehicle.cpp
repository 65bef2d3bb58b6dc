#include "lane_vehicle.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "eigen/gyrostat.hpp"
#include "hinged_block.hpp"
#include "ode/ode_engine.hpp"
#include "ode/world_contact.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/rotor_shares.hpp"

namespace quadcore::batch {
namespace {

/// Writes rows one after another.
class Rows {
 public:
  explicit Rows(std::vector<double>& rows) : rows_(rows) {}
  void put(std::size_t row, double number) { rows_[row] = number; }
  void put(std::size_t row, const Vector3d& v) { std::copy_n(v.data(), 3, &rows_[row]); }
  void put(std::size_t row, const Matrix3d& m) { std::copy_n(m.data(), 9, &rows_[row]); }

 private:
  std::vector<double>& rows_;
};

void put_gyrostat(const Model& model, LaneVehicle& vehicle) {
  using Row = ConstantRow;
  const Gyrostat body(model);
  vehicle.reach = std::max(-unbounded, find_reach(model, body));
  vehicle.laws.upright = body.upright;
  vehicle.laws.normals_turn = body.normals_turn;
  vehicle.laws.aligned = std::all_of(body.R_FR_at_zero.begin(), body.R_FR_at_zero.end(),
                                     [](const Matrix3d& R) { return R == Matrix3d::Identity(); });
  Rows rows(vehicle.constants);
  rows.put(Row::inverse_mass, body.inverse_mass);
  rows.put(Row::p_FCcm_F, body.p_FCcm_F);
  rows.put(Row::I_C_F, body.I_Ccm_F);
  rows.put(Row::inverse_reduced_I_F, body.inverse_reduced_I_F);
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    using Constant = RotorConstant;
    rows.put(Row::rotor(Row::axis_F, i), body.rotors.vector(Constant::axis_F, i));
    rows.put(Row::rotor(Row::p_CR_F, i), body.rotors.vector(Constant::p_CR_F, i));
    rows.put(Row::rotor(Row::p_CRcm_F, i), body.rotors.vector(Constant::p_CRcm_F, i));
    rows.put(Row::rotor(Row::moment, i), body.rotors.number(Constant::moment, i));
    rows.put(Row::rotor(Row::inverse_moment, i), body.rotors.number(Constant::inverse_moment, i));
    rows.put(Row::rotor(Row::damping, i), body.rotors.number(Constant::damping, i));
    rows.put(Row::rotor(Row::R_FR_at_zero, i), body.R_FR_at_zero[i]);
  }
}

/// Return the reach of the shapes from the frame's centre of mass [m], -unbounded without shapes,
/// or nothing if rotors have shapes that are not bodies of revolution.
std::optional<double> reach_of(const Model& model, const std::vector<Reach>& reaches) {
  double furthest = -unbounded;
  for (const Reach& reach : reaches) {
    double arm = 0;
    if (reach.body > 0) {
      const Joint& joint = model.joints[reach.body - 1];
      const Vector3d& center = model.links[reach.body].inertial.pose.xyz;
      if (center.cross(joint.axis).norm() > 1e-9) return std::nullopt;
      arm = (joint.pose.xyz - model.links[0].inertial.pose.xyz).norm() + center.norm();
    }
    furthest = std::max(furthest, arm + reach.length);
  }
  return furthest;
}

/// Return whether the vehicle is suitable.
bool put_hinged(const Model& model, const World& world, LaneVehicle& vehicle) {
  const OdeEngine engine(model, world, gazebo11_recipe);
  const HingedModel hinged(engine.bodies());
  if (!engine.may_float() || !hinged.is_star()) return false;
  if (world.ground_plane || !world.obstacles.empty()) {
    const std::optional<double> reach = reach_of(engine.model(), engine.reaches());
    if (!reach) return false;
    vehicle.reach = *reach;
  }
  // Near obstacles, the engine leaves the floating steps even without shapes.
  if (!world.obstacles.empty()) {
    vehicle.reach = std::max(vehicle.reach, reach_of_shapes(engine.model()));
  }
  vehicle.hinged = std::make_shared<const HingedModel>(hinged);
  const std::size_t rotors = model.joints.size();
  vehicle.constants.resize(HingedRow::constants(rotors));
  for (std::size_t i = 0; i <= rotors; ++i) {
    const std::vector<double> rows = body_constants(engine.model(), i);
    std::copy(rows.begin(), rows.end(),
              &vehicle.constants[ConstantRow::count(rotors) + i * BodyConstant::count]);
  }
  for (std::size_t i = 0; i < rotors; ++i) {
    Rows(vehicle.constants)
        .put(ConstantRow::rotor(ConstantRow::R_FR_at_zero, i),
             Matrix3d(engine.model().joints[i].pose.rotation().toRotationMatrix()));
  }
  return true;
}

bool are_same(const RotorConventions& one, const RotorConventions& other) {
  static_assert(std::has_unique_object_representations_v<RotorConventions>);
  return std::memcmp(&one, &other, sizeof one) == 0;
}

}  // namespace

std::optional<LaneVehicle> lane_vehicle(const Simulation& simulation) {
  const ForceLaws& force_laws = simulation.force_laws();
  const Model& model = simulation.model();
  const std::size_t rotors = model.joints.size();
  const bool like_gazebo = simulation.engine_name() == "gazebo11";
  if (!(like_gazebo || simulation.engine_name() == "eigen") || !force_laws.all_quiet ||
      !simulation.world().free_bodies.empty() || rotors > most_rotors ||
      force_laws.rotor_forces.size() > 1 || force_laws.frame_drags.size() > 1 ||
      force_laws.airframes.size() > 1 || force_laws.motor_torques.size() != 1) {
    return std::nullopt;
  }
  LaneVehicle vehicle{{}, unbounded, false, -unbounded, {}, {}, {}};
  vehicle.constants.resize(ConstantRow::count(rotors));
  if (!like_gazebo) {
    put_gyrostat(model, vehicle);
  } else if (!put_hinged(model, simulation.world(), vehicle)) {
    return std::nullopt;
  }
  for (const Quiet& quiet : force_laws.quiet) {
    vehicle.fastest = std::min(vehicle.fastest, quiet.fastest);
    vehicle.no_tilt |= quiet.no_tilt;
  }
  using Row = ConstantRow;
  Rows rows(vehicle.constants);
  for (const FrameDrag& law : force_laws.frame_drags) {
    vehicle.laws.drag = true;
    rows.put(Row::frame_drag, law.coefficient);
  }
  for (const AirframeLaws& law : force_laws.airframes) {
    vehicle.laws.airframe = true;
    for (std::size_t row = 0; row < AirframeRow::count; ++row) {
      rows.put(Row::airframe + row, law.coefficients[row]);
    }
  }
  for (const RotorForces& law : force_laws.rotor_forces) {
    vehicle.laws.conventions = law.conventions;
    vehicle.laws.acting = law.acting;
    rows.put(Row::sim_slow, law.sim_slow);
    for (std::size_t i = 0; i < rotors; ++i) {
      const double* column = law.coefficients + rotor_offset(laws::RotorLaws::rows, i);
      for (std::size_t row = 0; row < laws::RotorLaws::rows; ++row) {
        rows.put(Row::rotor(Row::coefficients + row, i), column[row * widest_lanes]);
      }
    }
  }
  const MotorTorques& motors = force_laws.motor_torques.front();
  rows.put(Row::kp, motors.kp);
  rows.put(Row::fastest, motors.fastest);
  rows.put(Row::motors_sim_slow, motors.sim_slow);
  vehicle.places.assign(motors.places, motors.places + rotors);
  return vehicle;
}

std::vector<LaneSensor> list_lane_sensors(const Simulation& simulation) {
  std::vector<LaneSensor> sensors;
  const Topics& topics = simulation.topics();
  if (topics.find(health_topic) >= 0) return sensors;
  for (const OdometrySensor& sensor : simulation.force_laws().odometry) {
    const Topic& topic = topics[sensor.topic];
    const auto writer = static_cast<std::size_t>(topic.writer);
    if (sensor.is_simple) {
      sensors.push_back({topic.name, simulation.plugins()[writer].name, sensor});
    }
  }
  return sensors;
}

bool fit(const LaneVehicle& one, const LaneVehicle& other) {
  const Laws &a = one.laws, &b = other.laws;
  return are_same(a.conventions, b.conventions) && a.upright == b.upright &&
         a.normals_turn == b.normals_turn && one.places == other.places &&
         !one.hinged == !other.hinged;
}

}  // namespace quadcore::batch
