#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "clear_balls.hpp"
#include "command_motors.hpp"
#include "lane_vehicle.hpp"
#include "quadcore/plugin/rotor_rows.hpp"

namespace quadcore::batch {

/// The vehicles of a batch in blocks of eight, moved only by their force laws.
class LaneBlocks {
 public:
  /// \param vehicles  null for vehicles that are not in the lanes
  LaneBlocks(const std::vector<std::shared_ptr<const LaneVehicle>>& vehicles, std::size_t rotors,
             const World& world);

  std::size_t rotors() const { return rotors_; }
  /// Return whether the states are those of bodies on hinges.
  bool are_hinged() const { return hinged_ != nullptr; }
  std::size_t blocks() const { return flies_.size() / widest_lanes; }
  /// Return the number of values of a vehicle in show().
  std::size_t shown_rows() const { return StateRow::count(rotors_); }
  /// Return the size of the work memory of steps and show().
  std::size_t work_size() const;

  /// Set the state of a vehicle, without commands or warnings so far.
  void begin(std::size_t vehicle, const std::vector<double>& engine_state);
  /// Set the targets of a vehicle's motors.
  void command(std::size_t vehicle, const double* speeds);
  /// Set the targets of the motors of vehicles of a block.
  void command(std::size_t block, const Commands& commands);
  /// Return whether a vehicle moves in the steps of its block.
  bool flies(std::size_t vehicle) const { return flies_[vehicle] != 0; }
  /// Set whether a vehicle moves in the steps of its block.
  void let_fly(std::size_t vehicle, bool flies);
  /// Remove the bounds of a vehicle beyond which its plugins have already warned.
  void lift_bounds(std::size_t vehicle, const std::vector<Quiet>& quiet);
  /// \param work       separate work memory of each thread
  /// \param steps      number of completed steps of each vehicle of the block, up to `count`
  /// \param variation  see Block
  void step(std::size_t block, std::int64_t count, double dt, double* work, std::int64_t* steps,
            double* variation = nullptr);

  /// Convert to and from the state that the engine saves, without changing the part of contacts.
  void get_engine_state(std::size_t vehicle, std::vector<double>& state) const;
  void set_engine_state(std::size_t vehicle, const std::vector<double>& state);
  /// Write the states of a block in rows of StateRow, but without the angles of hinged vehicles.
  void show(std::size_t block, double* work);
  /// Write the rows of Batch::get_state() for all vehicles of a block.
  void show(std::size_t block, std::size_t vehicles, double* work, double* rows);

  /// All variable data.
  struct Saved {
    LaneNumbers state, motors;
    std::vector<std::int64_t> flies, may_spin, may_tilt;
    std::vector<std::vector<double>> of_contact;
  };
  Saved save() const { return {state_, motors_, flies_, may_spin_, may_tilt_, of_contact_}; }
  void restore(const Saved& saved) {
    state_ = saved.state;
    motors_ = saved.motors;
    flies_ = saved.flies;
    may_spin_ = saved.may_spin;
    may_tilt_ = saved.may_tilt;
    of_contact_ = saved.of_contact;
  }

 private:
  template <class Table>
  static auto column(Table& table, std::size_t rows, std::size_t vehicle) {
    return table.data() + vehicle / widest_lanes * rows * widest_lanes + vehicle % widest_lanes;
  }
  bool is_empty() const { return state_.empty(); }
  std::size_t state_rows() const;
  std::size_t constant_rows() const;
  const double* constants_of(std::size_t vehicle) const {
    return column(constants_, constant_rows(),
                  constants_differ_ ? vehicle : vehicle % widest_lanes);
  }
  void choose_width();
  double hinged_angle(std::size_t vehicle, const double* shown, std::size_t j) const;
  bool move_clear_balls(std::size_t block, std::int64_t count, const std::int64_t* steps);
  Block view(std::size_t block, double* work, std::int64_t* steps);

  std::size_t rotors_;
  Laws laws_ = {};
  Bounds bounds_;
  Vector3d gravity_W_;
  bool constants_differ_;  ///< whether the constants differ; otherwise all blocks share one table
  LaneNumbers constants_, motors_, state_;
  std::vector<std::int64_t> flies_, may_spin_, may_tilt_;
  std::vector<int> places_;                ///< see LaneVehicle
  std::optional<ClearBalls> clear_balls_;  ///< empty in a world without obstacles
  std::shared_ptr<const HingedModel> hinged_;
  HingedTree tree_ = {};      ///< tree of hinged vehicles
  bool has_contact_ = false;  ///< whether hinged vehicles store contacts
  /// Last saved state of the engine for each hinged vehicle.
  std::vector<std::vector<double>> of_contact_;
  void (*step_)(const Block&, std::int64_t, double) = nullptr;
  void (*show_)(const Block&, double*) = nullptr;
  void (*command_)(const Block&, const int*, const Commands&) = nullptr;
};

}  // namespace quadcore::batch
