#pragma once

#include <memory>

#include "quadcore/control/reference_preview.hpp"

namespace quadcore QUADCORE_EXPORT {
namespace control {

/// The form that a controller has in the lanes, for one vehicle with whole rotors. It computes the
/// same as Controller::command(), but in one piece and without conversions.
class SingleLane {
 public:
  SingleLane();
  /// Return whether the controller has such a form, which is then prepared.
  /// \param period  time since the last call and until the next [s]
  bool prepare(double period, const Controller& controller, double* state);
  /// Compute the speeds to command until the next call.
  /// \param now     values of an odometry message
  /// \param wanted  with the flat state, if the controller uses it
  /// \param state, speeds  see Controller::command()
  void command(const Controller& controller, const double* now,
               const ReferencePreview::Point& wanted, double* state, double* speeds) const;

 private:
  int width_;  ///< lanes of the instructions that compute the one vehicle
  double period_ = 0;
  std::shared_ptr<const LaneController> lanes_;  ///< null if there is none for the period
};

}  // namespace control
}  // namespace quadcore
