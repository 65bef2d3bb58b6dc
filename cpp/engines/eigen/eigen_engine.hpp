#pragma once

#include <optional>

#include "compliant_ground.hpp"
#include "gyrostat.hpp"
#include "gyrostat_step.hpp"
#include "quadcore/engine.hpp"

namespace quadcore {

/// The exact engine: the vehicle as a gyrostat in reduced coordinates, integrated with the
/// classical fourth-order Runge-Kutta method; force laws are evaluated at every stage. Its contact
/// with a ground plane is approximate.
class EigenEngine final : public Engine {
 public:
  EigenEngine(const Model& model, const World& world);

  const Model& model() const override { return model_; }
  void step(double time, double dt, const ForceField& forces) override;
  Kinematics& kinematics() override { return kinematics_; }
  void get_state(VehicleState& state) const override;
  void set_state(const VehicleState& state) override;
  std::vector<double> save() const override;
  void restore(const std::vector<double>& saved) override;
  std::string method() const override;
  std::vector<std::string> warnings() const override;

 private:
  /// The step's view of this engine; it points into the members below.
  GyrostatStep view();
  void show();
  void evaluate_rest();
  void refuse();
  void take_given_rates();
  void end_given_rates();
  bool is_at_ground(double dt) const;
  void step_at_ground(double time, double dt);

  std::vector<std::string> warnings_;  ///< of how the model is taken
  Model model_;
  Gyrostat body_;
  Vector3d gravity_W_;
  std::optional<CompliantGround> ground_;  ///< none in a world without ground
  bool placed_ = true;                     ///< and not yet moved on the ground
  Kinematics kinematics_;
  Loads loads_;
  LaneNumbers state_, stage_, sum_;
  LaneNumbers joint_torques_, turns_;
  RotorRows<GivenRateRow::count> given_rates_;
  std::vector<bool> reacting_;  ///< joints of given rates whose rotors the frame turns with it
  GyrostatStep step_;
  void (*show_)(const GyrostatStep&, const double*);
  void (*advance_)(const GyrostatStep&, double, double);
  const ForceField* forces_ = nullptr;  ///< of the step that is under way
};

}  // namespace quadcore
