#pragma once

#include <optional>

#include "compliant_ground.hpp"
#include "compliant_obstacles.hpp"
#include "gyrostat.hpp"
#include "gyrostat_step.hpp"
#include "quadcore/engine.hpp"

namespace quadcore {

/// The most accurate engine: the vehicle is a gyrostat in reduced coordinates, integrated by the
/// classical fourth-order Runge-Kutta method with force laws evaluated at every stage. Its contact
/// is approximate.
class EigenEngine final : public Engine {
 public:
  EigenEngine(const Model& model, const World& world);

  const Model& model() const override { return model_; }
  void step(double time, double dt, const ForceField& forces) override;
  Kinematics& kinematics() override { return kinematics_; }
  void set_state(const VehicleState& state) override;
  std::vector<double> save() const override;
  void restore(const std::vector<double>& saved) override;
  std::string method() const override;
  std::vector<std::string> warnings() const override;

 private:
  /// Data of a step, which points into the members below.
  GyrostatStep view();
  void show();
  void evaluate_rest();
  void refuse();
  void take_given_rates();
  void end_given_rates();
  bool is_at_ground(double dt) const;
  bool is_at_obstacle(double dt);
  /// Step in as many parts, with the contact of the ground, and of obstacles if they are near.
  void step_in_contact(double time, double dt, int parts);
  std::size_t saved_size() const;

  std::vector<std::string> warnings_;  ///< on the interpretation of the model
  Model model_;
  Gyrostat body_;
  Vector3d gravity_W_;
  std::optional<CompliantGround> ground_;        ///< empty in a world without ground
  std::optional<CompliantObstacles> obstacles_;  ///< empty in a world without obstacles
  bool touches_obstacles_ = false;               ///< whether obstacles are near in this step
  bool placed_ = true;  ///< whether the state was set and has not moved in contact
  Kinematics kinematics_;
  Loads loads_;
  LaneNumbers state_, stage_, sum_;
  LaneNumbers joint_torques_, turns_;
  RotorRows<GivenRateRow::count> given_rates_;
  std::vector<bool> reacting_;  ///< joints with prescribed rates that react on the frame
  GyrostatStep step_;
  void (*show_)(const GyrostatStep&, const double*);
  void (*advance_)(const GyrostatStep&, double, double);
  const ForceField* forces_ = nullptr;  ///< force field of the present step
};

}  // namespace quadcore
