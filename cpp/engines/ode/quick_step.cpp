#include "quick_step.hpp"

#include <pthread.h>

#include <algorithm>
#include <mutex>

namespace quadcore {
namespace {

/// Cap of the correcting velocity in the solve for velocities, Gazebo's max_vel [m/s].
constexpr double max_correcting_velocity = 0.01;

/// Guards ODE's random generator; a child process starts with it free.
std::mutex& generator_mutex() {
  static std::mutex mutex;
  static const int once = pthread_atfork([] { mutex.lock(); }, [] { mutex.unlock(); },
                                         [] { mutex.unlock(); });
  static_cast<void>(once);
  return mutex;
}

}  // namespace

void seeded_quick_step(dWorldID world, double dt) {
  const std::lock_guard<std::mutex> lock(generator_mutex());
  dRandSetSeed(0);
  dWorldQuickStep(world, dt);
}

void SplitStep::step(dWorldID world, const std::vector<dBodyID>& bodies, double dt) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    save_pose(bodies[i], memory_[i].pose_before);
    save_velocity(bodies[i], memory_[i].velocity_before);
    std::copy_n(dBodyGetForce(bodies[i]), 3, memory_[i].force);
    std::copy_n(dBodyGetTorque(bodies[i]), 3, memory_[i].torque);
  }
  dWorldSetContactMaxCorrectingVel(world, dInfinity);
  seeded_quick_step(world, dt);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Memory& m = memory_[i];
    save_pose(bodies[i], memory_[i].pose_after);
    restore_pose(bodies[i], m.pose_before);
    restore_velocity(bodies[i], m.velocity_before);
    dBodySetForce(bodies[i], m.force[0], m.force[1], m.force[2]);
    dBodySetTorque(bodies[i], m.torque[0], m.torque[1], m.torque[2]);
  }
  dWorldSetContactMaxCorrectingVel(world, max_correcting_velocity);
  seeded_quick_step(world, dt);
  for (std::size_t i = 0; i < bodies.size(); ++i) restore_pose(bodies[i], memory_[i].pose_after);
}

}  // namespace quadcore
