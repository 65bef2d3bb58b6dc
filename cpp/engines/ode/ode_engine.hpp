#pragma once

#include <ode/ode.h>

#include <memory>
#include <vector>

#include "gazebo_step.hpp"
#include "ground_contact.hpp"
#include "gyroscopic.hpp"
#include "hinged_vehicle.hpp"
#include "ode_vehicle.hpp"
#include "quadcore/engine.hpp"

namespace quadcore {

/// How an ODE world is set up.
struct OdeRecipe {
  /// Fly what Gazebo's conversion from URDF to SDF leaves, by Gazebo's sweeps wherever they are not
  /// the direct solver's answer.
  bool like_gazebo;
  void (*add_gyroscopic)(GyroscopicVehicle&, double dt);
};

/// Gazebo 11 to the last digit, faults included.
extern const OdeRecipe gazebo11_recipe;
/// The same world without Gazebo's faults.
extern const OdeRecipe ode_recipe;

/// Whether a state that an engine has saved remembers no contact that it is beside.
bool is_clear_of_contact(const std::vector<double>& saved);

/// Rigid bodies on hinges in a world of upstream ODE.
class OdeEngine final : public Engine {
 public:
  OdeEngine(const Model& model, const World& world, const OdeRecipe& recipe);

  const Model& model() const override { return model_; }
  void step(double time, double dt, const ForceField& forces) override;
  Kinematics& kinematics() override { return kinematics_; }
  void get_state(VehicleState& state) const override;
  void set_state(const VehicleState& state) override;
  std::vector<double> save() const override;
  void restore(const std::vector<double>& saved) override;
  std::string method() const override { return method_; }
  std::vector<std::string> warnings() const override { return warnings_; }

  /// What moves: the bodies of model(), and in gazebo11 those behind locked joints.
  const Bodies& bodies() const { return bodies_; }
  /// Whether HingedVehicle alone moves it, while it is well above the ground.
  bool may_float() const { return may_float_; }
  /// Of its shapes, if there is a ground.
  const std::vector<Reach>& reaches() const { return ground_->reaches(); }

 private:
  struct FreeThreading {
    void operator()(dxThreadingImplementation* own) const { dThreadingFreeImplementation(own); }
  };
  struct DestroyWorld {
    void operator()(dxWorld* world) const { dWorldDestroy(world); }
  };

  void choose_method(const World& world);
  double remaining_error(double dt);
  void take_threading();
  bool is_afloat(double dt) const;
  bool float_by(double dt);
  void settle() const;
  void step_in_ode(double dt);
  bool solve(double dt);
  bool is_near_contact(double dt, bool touching);
  void remember_hinge_forces() const;
  void forget_hinge_forces();
  void show();
  std::size_t saved_size() const;

  Model model_;
  Bodies bodies_;  ///< see bodies()
  OdeRecipe recipe_;
  /// The world's own: ODE's default job list is shared by all worlds, without a lock.
  std::unique_ptr<dxThreadingImplementation, FreeThreading> threading_;
  std::unique_ptr<dxWorld, DestroyWorld> world_;
  bool iterate_ = false;  ///< every step by sweeps, because they do not converge
  std::string method_;
  std::vector<std::string> warnings_;
  std::unique_ptr<OdeVehicle> vehicle_;
  bool rubs_ = false;            ///< some hinge has dry friction, whose bounds are inequalities
  bool may_float_ = false;       ///< see may_float()
  HingedVehicle hinged_;         ///< moves as the bodies in ODE, or before them
  mutable bool behind_ = false;  ///< the bodies in ODE are
  std::unique_ptr<GroundContact> ground_;  ///< null in a world without ground
  int steps_since_contact_;                ///< counted no further than it matters
  std::unique_ptr<GazeboStep> gazebo_step_;
  std::unique_ptr<GyroscopicVehicle> gyroscopic_;
  double gravity_z_ = 0;
  Kinematics kinematics_;
  Loads loads_;
};

}  // namespace quadcore
