#pragma once

#include <ode/ode.h>

#include <memory>
#include <vector>

#include "gazebo_step.hpp"
#include "ground_contact.hpp"
#include "gyroscopic.hpp"
#include "quadcore/engine.hpp"

namespace quadcore {

/// How an ODE world is set up.
struct OdeRecipe {
  bool round_like_sdf;  ///< fly the numbers that Gazebo's URDF -> SDF conversion leaves
  void (*add_gyroscopic)(GyroscopicVehicle&, double dt);
};

/// Gazebo 11 to the last digit, faults included.
extern const OdeRecipe gazebo11_recipe;
/// The same world without Gazebo's faults.
extern const OdeRecipe ode_recipe;

/// Rigid bodies on hinges in upstream ODE: bodies sit at their centres of mass along their link's
/// axes, hinges are attached as (child, parent).
class OdeEngine final : public Engine {
 public:
  OdeEngine(const Model& model, const World& world, const OdeRecipe& recipe);

  const Model& model() const override { return model_; }
  void step(double dt, const ForceField& forces) override;
  const Kinematics& kinematics() const override { return kinematics_; }
  void get_state(VehicleState& state) const override;
  void set_state(const VehicleState& state) override;
  std::vector<double> save() const override;
  void restore(const std::vector<double>& saved) override;

 private:
  struct FreeThreading {
    void operator()(dxThreadingImplementation* own) const { dThreadingFreeImplementation(own); }
  };
  struct DestroyWorld {
    void operator()(dxWorld* world) const { dWorldDestroy(world); }
  };

  void create_bodies();
  std::vector<Hinge> create_hinges();
  void place(std::size_t link, const Eigen::Isometry3d& X_WL, const Vector3d& v_WL_W,
             const Vector3d& w_WL_W);
  void take_threading();
  void solve(double dt);
  void apply_loads();
  void remember_hinge_forces();
  std::size_t saved_size() const;
  void read_kinematics();

  Model model_;
  OdeRecipe recipe_;
  /// The world's own: ODE's default job list is shared by all worlds, without a lock.
  std::unique_ptr<dxThreadingImplementation, FreeThreading> threading_;
  std::unique_ptr<dxWorld, DestroyWorld> world_;
  bool iterate_;  ///< every step by sweeps, because the world asks for few of them
  std::vector<dBodyID> bodies_;
  std::unique_ptr<GroundContact> ground_;  ///< null in a world without ground
  std::unique_ptr<GazeboStep> gazebo_step_;
  std::vector<dJointID> hinges_;
  std::vector<dJointFeedback> feedback_;  ///< one per hinge in a world with ground
  std::unique_ptr<GyroscopicVehicle> gyroscopic_;
  double mass_ = 0;
  Vector3d wind_W_;
  Kinematics kinematics_;
  Loads loads_;
};

}  // namespace quadcore
