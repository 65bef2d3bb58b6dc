#pragma once

#include <memory>
#include <vector>

#include "follower.hpp"
#include "lane_controller.hpp"
#include "quadcore/control/reference_preview.hpp"
#include "quadcore/control/schedule.hpp"

namespace quadcore::batch {

/// Numbers of the vehicles of a block, as a struct of packs for each W vehicles.
class PackTable {
 public:
  PackTable(int width, std::size_t rows)
      : width_(static_cast<std::size_t>(width)), rows_(rows), numbers_(rows * widest_lanes) {}

  double& at(std::size_t row, std::size_t lane) { return first(lane)[row * width_]; }
  double* data() { return numbers_.data(); }
  /// Convert to and from the numbers of one vehicle.
  void put(std::size_t lane, const double* column) {
    double* const to = first(lane);
    for (std::size_t row = 0; row < rows_; ++row) to[row * width_] = column[row];
  }
  void get(std::size_t lane, double* column) {
    const double* const from = first(lane);
    for (std::size_t row = 0; row < rows_; ++row) column[row] = from[row * width_];
  }
  /// Set the numbers of all vehicles.
  void fill(const double* column);

 private:
  double* first(std::size_t lane) {
    return &numbers_[lane / width_ * rows_ * width_ + lane % width_];
  }

  std::size_t width_, rows_;
  LaneNumbers numbers_;
};

/// Followers of a block whose controllers have the same structure, rate and delay. The lanes call
/// them together, with the results of single calls.
class LaneControls {
 public:
  /// Make an empty group for followers like this one.
  LaneControls(const Follower& like, std::shared_ptr<const control::LaneController> controller);

  /// Return whether a follower fits into this group.
  bool takes(const Follower& follower, const control::LaneController& controller) const;
  void add(Follower& follower, const control::LaneController& controller,
           control::ReferencePreview& preview);

  /// Return the first step after an updated one at which calls are due or commands take effect.
  double next_event(double step, double dt) {
    return schedule_.next_event(step, dt, pending_.data());
  }
  /// Call the controllers if they are due.
  /// \param shown  rows of the block's states
  /// \param drop   called as drop(follower) for a follower whose controller fails
  /// \param take   called as take(follower, speeds) for each command that takes effect
  template <class Drop, class Take>
  void update(double step, double dt, const double* shown, const Drop& drop, const Take& take) {
    const double* const speeds =
        schedule_.update(step, dt, pending_.data(), [&](double period, double* asked) {
          command(step, dt, period, shown, asked);
          for (const Member& member : members_) {
            if (!member.is_defined && !member.follower->has_left) drop(*member.follower);
          }
        });
    if (!speeds) return;
    for (const Member& member : members_) {
      if (!member.follower->has_left) take(*member.follower, speeds + member.lane * rotors_);
    }
  }

 private:
  struct Member {
    Follower* follower;
    std::size_t lane;
    control::ReferencePreview* preview;
    bool is_defined;  ///< whether the reference has an attitude now
  };

  void command(double step, double dt, double period, const double* shown, double* speeds);
  void measure(double step, const double* shown);
  void read_references(double step, double dt);
  void call(double period);

  std::shared_ptr<const control::LaneController> like_;
  double rate_, delay_;
  const OdometryErrors* errors_;  ///< of the first follower
  std::size_t rotors_;
  int width_;
  std::vector<Member> members_;
  control::Schedule schedule_;
  std::vector<double> pending_;
  PackTable numbers_, actuators_, sensors_, measured_, wanted_, state_, demand_, speeds_;
  std::uint64_t seeds_[widest_lanes] = {}, counts_[widest_lanes] = {};
  bool has_begun_ = false;
};

}  // namespace quadcore::batch
