#pragma once

#include <ode/ode.h>

#include <memory>
#include <vector>

#include "free_bodies.hpp"
#include "gazebo_step.hpp"
#include "gyroscopic.hpp"
#include "hinged_vehicle.hpp"
#include "ode_vehicle.hpp"
#include "quadcore/engine.hpp"
#include "world_contact.hpp"

namespace quadcore {

/// Set-up of an ODE world.
struct OdeRecipe {
  /// Use the result of Gazebo's conversion from URDF to SDF, and Gazebo's sweeps unless they
  /// converge to the direct solution.
  bool like_gazebo;
  void (*add_gyroscopic)(GyroscopicVehicle&, double dt);
};

/// Gazebo 11 with bit-identical results, including its known errors.
extern const OdeRecipe gazebo11_recipe;
/// The same world without Gazebo's errors.
extern const OdeRecipe ode_recipe;

/// Return the settings of the sweeps in a world.
GazeboStep::Options gazebo_options(const World& world, const OdeRecipe& recipe,
                                   std::vector<GazeboStep::Damping> damping);

/// Return whether a saved state of an engine has no recent contact.
bool is_clear_of_contact(const std::vector<double>& saved);

/// Rigid bodies on hinges in a world of upstream ODE.
class OdeEngine final : public Engine {
 public:
  OdeEngine(const Model& model, const World& world, const OdeRecipe& recipe);

  const Model& model() const override { return model_; }
  void step(double time, double dt, const ForceField& forces) override;
  Kinematics& kinematics() override { return kinematics_; }
  void set_state(const VehicleState& state) override;
  std::vector<double> save() const override;
  void restore(const std::vector<double>& saved) override;
  std::string method() const override { return method_; }
  std::vector<std::string> warnings() const override { return warnings_; }
  std::vector<FreeBodyState> free_bodies() const override { return free_->states(); }

  /// Return the moving bodies: those of model(), and in gazebo11 also those behind locked joints.
  const Bodies& bodies() const { return bodies_; }
  /// Return whether only HingedVehicle moves it while it is well above the ground.
  bool may_float() const { return may_float_; }
  /// Return the reach of its shapes, if the world has anything to touch.
  const std::vector<Reach>& reaches() const { return contact_->reaches(); }

  /// \name Parts of a step, for contact with other vehicles and free bodies
  /// @{
  /// Prepare for contact that is not with the ground or an obstacle.
  void expect_contact();
  /// Evaluate the forces of a step.
  void evaluate(double time, const ForceField& forces);
  /// Finish a step in which this vehicle touches no other and no free body.
  /// \param near  whether it may touch one within the next steps
  void move(double dt, bool near);
  /// Update the bodies in ODE.
  void settle() const;
  /// Add the forces of a step to the bodies in ODE.
  void push(double dt);
  /// Take over the motion of the bodies in ODE after a step in contact.
  void take_motion();
  const OdeRecipe& recipe() const { return recipe_; }
  const HingedVehicle& hinged() const { return hinged_; }
  const OdeVehicle& vehicle() const { return *vehicle_; }
  std::vector<GazeboStep::WarmStart>& warm_start() { return gazebo_step_->warm_start; }
  /// @}

 private:
  struct FreeThreading {
    void operator()(dxThreadingImplementation* own) const { dThreadingFreeImplementation(own); }
  };
  struct DestroyWorld {
    void operator()(dxWorld* world) const { dWorldDestroy(world); }
  };

  void create_step(const World& world);
  void choose_method(const World& world);
  double remaining_error(double dt);
  void take_threading();
  bool is_afloat(double dt) const;
  bool float_on(double dt);
  bool float_by_laws(double dt, const ForceLaws& laws);
  void step_in_ode(double dt, bool near);
  void step_free(double dt);
  bool touches_vehicle(const std::vector<Contact>& contacts) const;
  void put_to_sleep(const std::vector<Contact>& contacts, double dt);
  bool solve(double dt);
  bool is_near_contact(double dt, bool touching, bool near);
  void remember_hinge_forces() const;
  void forget_hinge_forces();
  void show();
  std::size_t saved_size() const;

  Model model_;
  Bodies bodies_;  ///< see bodies()
  OdeRecipe recipe_;
  /// Own job list, because all worlds share ODE's default one without a lock.
  std::unique_ptr<dxThreadingImplementation, FreeThreading> threading_;
  std::unique_ptr<dxWorld, DestroyWorld> world_;
  bool iterate_ = false;  ///< whether to use sweeps in every step because they do not converge
  std::string method_;
  std::vector<std::string> warnings_;
  std::unique_ptr<OdeVehicle> vehicle_;
  bool rubs_ = false;       ///< whether some hinge has dry friction, which requires inequalities
  bool may_float_ = false;  ///< see may_float()
  HingedVehicle hinged_;    ///< same motion as the bodies in ODE, possibly ahead of them
  mutable bool behind_ = false;            ///< whether the bodies in ODE are behind hinged_
  std::unique_ptr<WorldContact> contact_;  ///< null in a world without ground and obstacles
  bool may_touch_ = false;                 ///< whether there is anything to touch
  int steps_since_contact_;                ///< counted only as far as it matters
  std::unique_ptr<FreeBodies> free_;
  std::vector<dBodyID> all_bodies_;  ///< those of the vehicle, then the free ones
  std::unique_ptr<GazeboStep> gazebo_step_;
  std::unique_ptr<GyroscopicVehicle> gyroscopic_;
  double gravity_z_ = 0;
  Kinematics kinematics_;
  Loads loads_;
};

}  // namespace quadcore
