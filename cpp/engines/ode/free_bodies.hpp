#pragma once

#include <ode/ode.h>

#include <memory>
#include <vector>

#include "constraint_rows.hpp"
#include "gazebo_step.hpp"
#include "quadcore/plugin/world.hpp"

namespace quadcore {

/// The free bodies of a world as bodies of an ODE world of their own. Like Gazebo, it lets a body
/// without joints sleep after a second of rest in contact.
class FreeBodies {
 public:
  explicit FreeBodies(const World& world);

  const std::vector<dBodyID>& bodies() const { return bodies_; }
  bool empty() const { return bodies_.empty(); }
  /// Return the joints, with indices of the bodies that begin at `first`.
  std::vector<Hinge> hinge_rows(std::size_t first) const;
  /// Return the part of its velocities that each body loses.
  std::vector<GazeboStep::Damping> damping() const;

  /// Add the gyroscopic torques, and springs and damping of the joints.
  void push() const;
  /// Let bodies sleep that rest in contact.
  /// \param first  index of the first free body among those of the contacts
  /// \param asleep  whether each body sleeps, free bodies from `first` on
  void put_to_sleep(const std::vector<Contact>& contacts, double dt, std::size_t first,
                    std::vector<char>& asleep);

  std::vector<FreeBodyState> states() const;
  /// Return the number of values of save().
  std::size_t saved_size() const;
  /// Write poses, velocities and how long each body rested; returns the end.
  double* save(double* to) const;
  const double* restore(const double* from);

 private:
  struct DestroyWorld {
    void operator()(dxWorld* world) const { dWorldDestroy(world); }
  };
  void create(const FreeBody& given);
  void push_joint(const FreeJoint& joint) const;

  std::vector<FreeBody> given_;
  std::vector<FreeJoint> joints_;
  std::unique_ptr<dxWorld, DestroyWorld> world_;
  std::vector<dBodyID> bodies_;
  std::vector<Matrix3d> inertia_;  ///< of each about its centre of mass in its own axes [kg m^2]
  /// Time and steps of rest that remain before a body sleeps.
  struct Rest {
    double time, steps;
  };
  std::vector<Rest> rest_;
  std::vector<char> touching_;
};

}  // namespace quadcore
