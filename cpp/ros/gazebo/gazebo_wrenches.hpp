#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "quadcore/simulation.hpp"

namespace quadcore::node {

/// Throws InputError on a wrench that is not finite, or that would end the flight as diverged soon
/// after it acts.
void check_wrench(const Simulation& simulation, const messages::Wrench& wrench);

/// Forces and torques that act on the frame for a time, as gazebo_ros' service applies them: on its
/// centre of mass, in axes of the world.
class GazeboWrenches {
 public:
  static constexpr const char* topic = "gazebo_wrench";
  /// The plugin that lets them act.
  static PluginElement plugin(const Model& model);

  /// \param begin, end  when it acts [s]; it acts for a step at least
  void add(const messages::Wrench& wrench, double begin, double end);
  void clear();
  /// Before a step: tells the plugin what acts in it.
  void act(Simulation& simulation);

 private:
  struct Wrench {
    messages::Wrench wrench;
    double begin, end;  ///< s
    bool has_acted = false;
  };

  std::mutex mutex_;
  std::vector<Wrench> wrenches_;
  bool acts_ = false;  ///< the plugin was told of one
};

}  // namespace quadcore::node
