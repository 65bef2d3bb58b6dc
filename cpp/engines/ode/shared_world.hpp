#pragma once

#include <memory>
#include <vector>

#include "ode_engine.hpp"

namespace quadcore {

/// Several vehicles and the free bodies of a world. A vehicle that touches none of the others moves
/// by its own engine, bit for bit as if it were alone. Those that touch take Gazebo's step
/// together.
class OdeSharedWorld final : public SharedWorld {
 public:
  OdeSharedWorld(const std::vector<OdeEngine*>& engines, const World& world);

  void step(double dt, const std::vector<TimedForces>& forces) override;
  std::vector<FreeBodyState> free_bodies() const override { return free_.states(); }
  std::vector<double> save() const override;
  void restore(const std::vector<double>& saved) override;
  std::vector<std::string> warnings() const override { return {}; }

 private:
  /// A vehicle's place in the lists of all bodies and hinges.
  struct Vehicle {
    OdeEngine* engine;
    std::size_t first_body, first_hinge;
    double reach;  ///< of its shapes from the frame's centre of mass [m]
  };

  void create_step(const World& world);
  void find_close(double dt);
  void find_touching(const std::vector<Contact>& contacts);
  void step_together(const std::vector<Contact>& contacts, double dt);
  std::vector<GazeboStep::WarmStart>::iterator warm_start_of(std::size_t vehicle);
  bool are_free_bodies_asleep() const;
  std::size_t saved_size() const;

  std::vector<Vehicle> vehicles_;
  FreeBodies free_;
  std::vector<dBodyID> bodies_;      ///< those of the vehicles, then the free ones
  std::size_t first_joint_ = 0;      ///< index of the first joint of a free body among all hinges
  std::size_t first_free_ = 0;       ///< index of the first free body
  std::vector<std::size_t> owners_;  ///< vehicle of each body
  std::unique_ptr<WorldContact> contact_;
  std::unique_ptr<GazeboStep> step_;   ///< warm starts of the vehicles are those of their engines
  std::vector<Vector3d> positions_W_;  ///< of the frames' centres of mass
  std::vector<char> close_, touching_, near_free_;  ///< for each vehicle
};

}  // namespace quadcore
