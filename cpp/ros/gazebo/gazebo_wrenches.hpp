#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// Throws InputError if a wrench is not finite, or if the flight would diverge soon after it acts.
void check_wrench(const Simulation& simulation, const messages::Wrench& wrench);

/// Forces and torques that act on the frame for a time, like those of gazebo_ros' service: on its
/// centre of mass, in world axes.
class GazeboWrenches {
 public:
  static constexpr const char* topic = "gazebo_wrench";
  /// Returns the plugin that applies them.
  static PluginElement plugin(const Model& model);

  /// \param begin, end  time interval [s]; a wrench acts for at least one step
  void add(const messages::Wrench& wrench, double begin, double end);
  void clear();
  /// Publishes the sum of the active wrenches to the plugin. Call before a step.
  void act(Simulation& simulation);

 private:
  struct Wrench {
    messages::Wrench wrench;
    double begin, end;  ///< s
    bool has_acted = false;
  };

  std::mutex mutex_;
  std::vector<Wrench> wrenches_;
  bool acts_ = false;  ///< the plugin has an active wrench
};

}  // namespace quadcore::node
