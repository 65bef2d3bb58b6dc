#pragma once

#include <memory>
#include <vector>

#include "lane_blocks.hpp"
#include "members.hpp"
#include "quadcore/control/reference_preview.hpp"
#include "quadcore/control/schedule.hpp"
#include "quadcore/control/total_variation.hpp"

namespace quadcore::batch {

/// A vehicle of a block that follows a reference in the lanes.
struct Follower {
  std::size_t vehicle;
  const BatchGuide* guide;
  BatchGuided* guided;
  const OdometryErrors* errors;
  std::uint64_t seed;  ///< of the odometry
  double draws;        ///< random numbers before the measurement at the start
  control::TotalVariation rates, commands;
  bool has_left = false;  ///< whether it has left the lanes; its results are then incomplete

  /// Speeds in effect at the end; empty before the first command.
  std::vector<double> speeds = {};
};

/// Return the odometry of a shown state.
/// \param shown  column of the vehicle in the rows of LaneBlocks::show()
/// \param draws  random numbers before this measurement
messages::Odometry measure(const double* shown, const OdometryErrors& errors, std::uint64_t seed,
                           double draws);

/// Advances the vehicles of a block under their controllers, in the lanes.
class GuidedBlock {
 public:
  /// \param work  see LaneBlocks::work_size()
  GuidedBlock(LaneBlocks& lanes, std::size_t block, double dt, double* work)
      : lanes_(lanes), block_(block), dt_(dt), work_(work) {}

  /// Advance by n steps. A follower leaves the lanes where its flight needs more than the lanes
  /// model, or its controller fails. It then no longer moves.
  void advance(std::vector<Follower>& followers, std::int64_t n, std::int64_t log_every);

 private:
  struct Control;

  Control take_control(Follower& follower);
  control::ReferencePreview& preview_of(const Control& control);
  void update(Control& control, double step);
  void command(Control& control, double step, double period, double* speeds);
  void log(const Follower& follower, double step) const;
  void drop(Follower& follower);
  void step(std::vector<Follower>& followers);
  void note_rates(Follower& follower) const;
  double shown(std::size_t row, const Follower& follower) const {
    return work_[row * widest_lanes + follower.vehicle % widest_lanes];
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
};

/// Advance a simulation by n steps under a controller.
/// \param odometry  topic of the measured state
/// Throws what the controller throws, and FlightError if the flight fails; `guided` then contains
/// the flight up to this.
void follow_apart(Simulation& simulation, const BatchGuide& guide, const std::string& odometry,
                  std::int64_t n, std::int64_t log_every, BatchGuided& guided);

}  // namespace quadcore::batch
