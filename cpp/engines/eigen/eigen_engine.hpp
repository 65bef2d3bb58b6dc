#pragma once

#include <vector>

#include "gyrostat.hpp"
#include "quadcore/engine.hpp"

namespace quadcore {

/// The exact engine: the vehicle as a gyrostat in reduced coordinates, integrated with the
/// classical fourth-order Runge-Kutta method; force laws are evaluated at every stage. It has no
/// contact: touching a ground plane ends the flight.
class EigenEngine final : public Engine {
 public:
  EigenEngine(const Model& model, const World& world);

  const Model& model() const override { return model_; }
  void step(double dt, const ForceField& forces) override;
  const Kinematics& kinematics() const override { return kinematics_; }
  void get_state(VehicleState& state) const override;
  void set_state(const VehicleState& state) override;
  std::vector<double> save() const override;
  void restore(const std::vector<double>& saved) override;
  std::string method() const override;

 private:
  /// The layout of a state, or of its rate: p_WC, quaternion of F in W (x, y, z, w), v_WC_W,
  /// w_WF_F, then joint rates and joint angles.
  enum Layout { kPosition = 0, kOrientation = 3, kVelocity = 7, kRate = 10, kJoints = 13 };

  Eigen::Index joint_rates() const { return kJoints; }
  Eigen::Index joint_angles() const { return kJoints + rotor_count_; }
  /// Fills kinematics_ from a state.
  void look(const VectorXd& state);
  /// Puts the rate of the state, which kinematics_ shows, into rate_.
  void differentiate(const VectorXd& state, const ForceField& forces);
  /// One more stage of Runge-Kutta: the rate at state_ + reach rate_, which adds to sum_.
  void stage(double reach, double weight, const ForceField& forces);
  void refuse_ground() const;

  Model model_;
  Gyrostat body_;
  Eigen::Index rotor_count_;
  Vector3d gravity_W_, wind_W_;
  bool windy_, ground_;
  VectorXd state_, stage_, rate_, sum_;
  Kinematics kinematics_;
  Loads loads_;
};

}  // namespace quadcore
