#include "lane_vehicle.hpp"

#include <algorithm>

#include "eigen/compliant_ground.hpp"
#include "eigen/gyrostat.hpp"
#include "quadcore/error.hpp"

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

}  // namespace

std::optional<LaneVehicle> lane_vehicle(Simulation& simulation) {
  const ForceLaws& told = simulation.force_laws();
  const Model& model = simulation.model();
  const std::size_t rotors = model.joints.size();
  if (simulation.engine_name() != "eigen" || !told.all_quiet || rotors > most_rotors ||
      told.rotor_forces.size() > 1 || told.frame_drags.size() > 1 ||
      told.motor_torques.size() != 1) {
    return std::nullopt;
  }
  // The tables of the laws hold what they do once a step has begun.
  const Snapshot start = simulation.snapshot();
  try {
    simulation.step();
  } catch (const FlightError&) {
    simulation.restore(start);
    return std::nullopt;
  }
  const Gyrostat body(model);
  LaneVehicle vehicle{{}, unbounded, false, -unbounded, {}, {}};
  if (simulation.world().ground_plane) vehicle.reach = CompliantGround(model, body).reach();
  for (const Quiet& quiet : told.quiet) {
    vehicle.fastest = std::min(vehicle.fastest, quiet.fastest);
    vehicle.no_tilt |= quiet.no_tilt;
  }
  vehicle.constants.resize(ConstantRow::count(rotors));
  Rows rows(vehicle.constants);
  using Row = ConstantRow;
  rows.put(Row::inverse_mass, body.inverse_mass);
  rows.put(Row::p_FCcm_F, body.p_FCcm_F);
  rows.put(Row::I_C_F, body.I_Ccm_F);
  rows.put(Row::inverse_reduced_I_F, body.inverse_reduced_I_F);
  rows.put(Row::flapping + 4, 1.0);  // a radius, where nothing flaps

  Laws& laws = vehicle.laws;
  laws.upright = body.upright;
  laws.normals_turn = laws.turn = body.normals_turn;
  for (const FrameDrag& law : told.frame_drags) {
    laws.drag = true;
    rows.put(Row::frame_drag, law.coefficient);
  }
  for (const RotorForces& law : told.rotor_forces) {
    laws.forces = true;
    laws.across_link_z = law.across_link_z;
    laws.at_origins = law.at_origins;
    laws.about_frame_z = law.about_frame_z;
    laws.on_rotor = law.on_rotor;
    laws.parasitic = law.parasitic;
    laws.flaps = law.flaps;
    laws.turn |= law.parasitic;
    rows.put(Row::sim_slow, law.sim_slow);
    rows.put(Row::flapping, Vector3d(law.flapping.A1c, law.flapping.A1s, law.flapping.B1));
    rows.put(Row::flapping + 3, law.flapping.B2);
    rows.put(Row::flapping + 4, law.flapping.radius);
    for (std::size_t i = 0; i < rotors; ++i) {
      const double* column = law.coefficients + rotor_offset(CoefficientRow::count, i);
      for (std::size_t row = 0; row < CoefficientRow::count; ++row) {
        rows.put(Row::rotor(Row::coefficients + row, i), column[row * widest_lanes]);
      }
    }
  }
  const MotorTorques& motors = told.motor_torques.front();
  laws.motors = true;
  rows.put(Row::kp, motors.kp);
  rows.put(Row::fastest, motors.fastest);
  rows.put(Row::motors_sim_slow, motors.sim_slow);
  for (std::size_t i = 0; i < rotors; ++i) {
    using Constant = RotorConstant;
    rows.put(Row::rotor(Row::axis_F, i), body.rotors.vector(Constant::axis_F, i));
    rows.put(Row::rotor(Row::p_CR_F, i), body.rotors.vector(Constant::p_CR_F, i));
    rows.put(Row::rotor(Row::p_CRcm_F, i), body.rotors.vector(Constant::p_CRcm_F, i));
    rows.put(Row::rotor(Row::moment, i), body.rotors.number(Constant::moment, i));
    rows.put(Row::rotor(Row::inverse_moment, i), body.rotors.number(Constant::inverse_moment, i));
    rows.put(Row::rotor(Row::damping, i), body.rotors.number(Constant::damping, i));
    rows.put(Row::rotor(Row::R_FR_at_zero, i), body.R_FR_at_zero[i]);
    vehicle.places.push_back(motors.places[i]);
  }
  simulation.restore(start);
  return vehicle;
}

bool fit(const LaneVehicle& one, const LaneVehicle& other) {
  const Laws &a = one.laws, &b = other.laws;
  return a.across_link_z == b.across_link_z && a.at_origins == b.at_origins &&
         a.about_frame_z == b.about_frame_z && a.on_rotor == b.on_rotor && a.forces == b.forces &&
         a.drag == b.drag && a.parasitic == b.parasitic && a.flaps == b.flaps &&
         a.upright == b.upright && a.normals_turn == b.normals_turn && one.places == other.places;
}

}  // namespace quadcore::batch
