#pragma once

#include <memory>
#include <vector>

#include "follower.hpp"
#include "lane_blocks.hpp"
#include "lane_controls.hpp"
#include "members.hpp"
#include "shared_poll.hpp"

namespace quadcore::batch {

/// Advances the vehicles of a block under their controllers, in the lanes.
class GuidedBlock {
 public:
  /// \param work  see LaneBlocks::work_size()
  GuidedBlock(LaneBlocks& lanes, std::size_t block, double dt, double* work);
  ~GuidedBlock();

  /// Advance by n steps. A follower leaves the lanes where its flight needs more than the lanes
  /// model, or its controller fails. It then no longer moves. Throws what `poll` throws; the
  /// followers are then where the last steps took them.
  void advance(std::vector<Follower>& followers, std::int64_t n, std::int64_t log_every,
               SharedPoll& poll);

 private:
  struct Control;

  void add(Follower& follower);
  control::ReferencePreview& preview_of(const BatchGuide& guide);
  double update(double step, double next);
  void update(Control& control, double step);
  void take(Control& control, const double* speeds);
  void command(Control& control, double step, double period, double* speeds);
  void log(const Follower& follower, double step) const;
  void step(std::vector<Follower>& followers, std::int64_t count);
  void finish(const std::vector<Follower>& followers) const;
  void begin_rates();
  double shown(std::size_t row, const Follower& follower) const {
    return work_[row * widest_lanes + follower.lane()];
  }

  LaneBlocks& lanes_;
  std::size_t block_;
  double dt_;
  double* work_;
  /// One preview for all followers of the same reference under the same controller at the same
  /// rate.
  struct Shared {
    const BatchGuide* guide;
    std::unique_ptr<control::ReferencePreview> preview;
  };
  std::vector<Shared> previews_;
  std::vector<LaneControls> in_lanes_;
  std::vector<Control> alone_;  ///< controllers that are only for single vehicles
  LaneNumbers rates_;           ///< variation of the joint rates, see Block
};

/// Advance a simulation by n steps under a controller.
/// \param odometry  topic of the measured state
/// Throws what the controller and `poll` throw, and FlightError if the flight fails; `guided` then
/// contains the flight up to this.
void follow_apart(Simulation& simulation, const BatchGuide& guide, const std::string& odometry,
                  std::int64_t n, std::int64_t log_every, BatchGuided& guided, SharedPoll& poll);

}  // namespace quadcore::batch
