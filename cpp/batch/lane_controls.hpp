#pragma once

#include <memory>
#include <vector>

#include "follower.hpp"
#include "lane_blocks.hpp"
#include "lane_controller.hpp"
#include "pack_table.hpp"
#include "quadcore/control/reference_preview.hpp"
#include "quadcore/control/schedule.hpp"

namespace quadcore::batch {

/// Followers of a block whose controllers have the same structure, rate and delay. The lanes call
/// them and command their motors together, with the results of single calls.
class LaneControls {
 public:
  /// Make an empty group for followers like this one.
  LaneControls(LaneBlocks& lanes, double dt, const Follower& like,
               std::shared_ptr<const control::LaneController> controller);

  /// Return whether a follower fits into this group.
  bool takes(const Follower& follower, const control::LaneController& controller) const;
  void add(Follower& follower, const control::LaneController& controller,
           control::ReferencePreview& preview);

  /// Return the first step after an updated one at which calls are due or commands take effect.
  double next_event(double step) { return schedule_.next_event(step, dt_, pending_.data()); }
  /// Call the controllers if they are due, and command the motors if commands take effect.
  /// Followers whose controllers fail leave the lanes.
  /// \param shown  rows of the block's states
  void update(double step, const double* shown);
  /// Write the results of the followers.
  void finish() const;

 private:
  /// A reference, and its followers under one controller.
  struct Followed {
    control::ReferencePreview* preview;
    std::vector<Follower*> followers;
  };

  void call(double step, double period, const double* shown);
  void measure(double step, const double* shown);
  void read_references(double step);
  void command(double period);
  void take();

  LaneBlocks& lanes_;
  double dt_;
  std::shared_ptr<const control::LaneController> like_;
  double rate_, delay_;
  const OdometryErrors* errors_;  ///< of the first follower
  std::size_t rotors_;
  int width_;
  std::vector<Follower*> followers_;
  std::vector<Followed> followed_;
  control::Schedule schedule_;
  std::vector<double> pending_;
  PackTable numbers_, actuators_, sensors_, measured_, wanted_, state_, demand_;
  PackTable asked_, in_effect_;  ///< commands of the last call, and those in effect
  LaneNumbers variation_;        ///< of the commands in effect, see Commands
  std::uint64_t seeds_[widest_lanes] = {}, begins_[widest_lanes] = {};
  std::int64_t belong_[widest_lanes] = {};  ///< -1 for each vehicle of this group
  double saturated_[widest_lanes] = {};     ///< number of saturated calls
  std::int64_t calls_ = 0;
  std::vector<double> seconds_;  ///< durations of some calls of all controllers
  bool has_begun_ = false, has_commanded_ = false;
};

}  // namespace quadcore::batch
