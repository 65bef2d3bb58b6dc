#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lane_vehicle.hpp"
#include "quadcore/plugin/rotor_rows.hpp"

namespace quadcore::batch {

/// The vehicles of a batch, eight to a block, as their laws alone move them.
class LaneBlocks {
 public:
  /// \param vehicles  of which those that are null are not in the lanes
  LaneBlocks(const std::vector<std::shared_ptr<const LaneVehicle>>& vehicles, std::size_t rotors,
             const World& world);

  std::size_t blocks() const { return flies_.size() / widest_lanes; }
  /// Numbers of a vehicle in show().
  std::size_t shown_rows() const { return StateRow::count(rotors_); }
  /// Numbers of the room that steps and show() work in.
  std::size_t work_size() const;

  /// Takes a vehicle to a state, in which nothing was commanded or warned of yet.
  void begin(std::size_t vehicle, const std::vector<double>& engine_state);
  /// Sets what the motors of a vehicle follow.
  void command(std::size_t vehicle, const double* speeds);
  /// Whether a vehicle moves in steps of its block.
  void let_fly(std::size_t vehicle, bool flies);
  /// Lifts the bounds of a vehicle beyond which its plugins have no more to say.
  void lift_bounds(std::size_t vehicle, const std::vector<Quiet>& quiet);
  /// \param work   room of its own for each thread
  /// \param steps  of each vehicle of the block: how many of `count` it has flown
  void step(std::size_t block, std::int64_t count, double dt, double* work, std::int64_t* steps);

  /// To and from the state that the engine saves, of which the ground's part stays as it is.
  void get_engine_state(std::size_t vehicle, std::vector<double>& state) const;
  void set_engine_state(std::size_t vehicle, const std::vector<double>& state);
  /// As Batch::get_state() has it, the rows of all vehicles of a block that there are.
  void show(std::size_t block, std::size_t vehicles, double* work, double* rows);

  /// All that changes.
  struct Saved {
    LaneNumbers state, motors;
    std::vector<std::int64_t> flies, may_spin, may_tilt;
    std::vector<std::vector<double>> of_ground;
  };
  Saved save() const { return {state_, motors_, flies_, may_spin_, may_tilt_, of_ground_}; }
  void restore(const Saved& saved) {
    state_ = saved.state;
    motors_ = saved.motors;
    flies_ = saved.flies;
    may_spin_ = saved.may_spin;
    may_tilt_ = saved.may_tilt;
    of_ground_ = saved.of_ground;
  }

 private:
  template <class Table>
  static auto column(Table& table, std::size_t rows, std::size_t vehicle) {
    return table.data() + vehicle / widest_lanes * rows * widest_lanes + vehicle % widest_lanes;
  }
  bool is_empty() const { return state_.empty(); }
  bool are_hinged() const { return hinged_ != nullptr; }
  std::size_t state_rows() const;
  std::size_t constant_rows() const;
  const double* constants_of(std::size_t vehicle) const {
    return column(constants_, constant_rows(),
                  constants_differ_ ? vehicle : vehicle % widest_lanes);
  }
  void choose_width();
  double hinged_angle(std::size_t vehicle, const double* shown, std::size_t j) const;
  Block view(std::size_t block, double* work, std::int64_t* steps);

  std::size_t rotors_;
  Laws laws_ = {};
  Bounds bounds_;
  Vector3d gravity_W_;
  bool constants_differ_;  ///< or all blocks share one
  LaneNumbers constants_, motors_, state_;
  std::vector<std::int64_t> flies_, may_spin_, may_tilt_;
  std::vector<int> places_;  ///< as LaneVehicle has them
  std::shared_ptr<const HingedModel> hinged_;
  HingedTree tree_ = {};     ///< of hinged ones
  bool has_ground_ = false;  ///< and they remember it
  /// What the engine has saved last of each of these.
  std::vector<std::vector<double>> of_ground_;
  void (*step_)(const Block&, std::int64_t, double) = nullptr;
  void (*show_)(const Block&, double*) = nullptr;
};

}  // namespace quadcore::batch
