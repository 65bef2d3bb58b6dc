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
  /// Fly what Gazebo's conversion from URDF to SDF leaves, by Gazebo's sweeps wherever they are not
  /// the direct solver's answer.
  bool like_gazebo;
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
  void step(double time, double dt, const ForceField& forces) override;
  Kinematics& kinematics() override { return kinematics_; }
  void get_state(VehicleState& state) const override;
  void set_state(const VehicleState& state) override;
  std::vector<double> save() const override;
  void restore(const std::vector<double>& saved) override;
  std::string method() const override { return method_; }
  std::vector<std::string> warnings() const override { return warnings_; }

 private:
  struct FreeThreading {
    void operator()(dxThreadingImplementation* own) const { dThreadingFreeImplementation(own); }
  };
  struct DestroyWorld {
    void operator()(dxWorld* world) const { dWorldDestroy(world); }
  };

  void create_bodies();
  std::vector<Hinge> create_hinges();
  void choose_method(const World& world);
  double remaining_error(double dt);
  void place(std::size_t link, const Eigen::Isometry3d& X_WL, const Vector3d& v_WL_W,
             const Vector3d& w_WL_W);
  void take_threading();
  void solve(double dt);
  bool is_near_contact(double dt, bool touching);
  void apply_loads();
  void damp_bodies();
  void remember_hinge_forces();
  std::size_t saved_size() const;
  void read_kinematics();

  Model model_;
  OdeRecipe recipe_;
  /// The world's own: ODE's default job list is shared by all worlds, without a lock.
  std::unique_ptr<dxThreadingImplementation, FreeThreading> threading_;
  std::unique_ptr<dxWorld, DestroyWorld> world_;
  bool iterate_ = false;  ///< every step by sweeps, because they do not converge
  std::string method_;
  std::vector<std::string> warnings_;
  std::vector<dBodyID> bodies_;
  std::unique_ptr<GroundContact> ground_;  ///< null in a world without ground
  int steps_since_contact_;                ///< counted no further than it matters
  std::unique_ptr<GazeboStep> gazebo_step_;
  std::vector<dJointID> hinges_;
  std::vector<dJointFeedback> feedback_;  ///< one per hinge in a world with ground
  std::unique_ptr<GyroscopicVehicle> gyroscopic_;
  double mass_ = 0;
  double gravity_z_ = 0;
  Kinematics kinematics_;
  Loads loads_;
};

}  // namespace quadcore
