#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "quadcore/control/allocation.hpp"
#include "quadcore/control/flat_state.hpp"
#include "quadcore/control/modelled_vehicle.hpp"
#include "quadcore/control/reference.hpp"

namespace quadcore QUADCORE_EXPORT {
/// Controllers: a WrenchController computes the thrust and torques that keep a vehicle on its
/// reference, and an allocation computes the rotor speeds for them.
namespace control {

using messages::Odometry;

/// Input of a WrenchController.
struct ControllerInput {
  double period;            ///< time since the last call and until the next [s]
  bool begins;              ///< whether this is the first call
  const Odometry& now;      ///< linear velocity in W
  const Reference& wanted;  ///< reference
  const FlatState*
      flat;        ///< its flat state as WrenchController::feeds() requires; null: not computed
  Demand exerted;  ///< modelled wrench of the rotors now
  Vector3d h_F;    ///< modelled angular momentum of the rotors now [kg m^2/s]
  bool saturated;  ///< whether the last demand was not met
};

struct LaneWrenchController;

/// A control law: it computes thrust and torques from odometry and reference. It is immutable; the
/// caller owns its memory, which is all zero at the start.
class WrenchController {
 public:
  virtual ~WrenchController() = default;
  /// How a controller uses the flat state of the reference.
  enum class Feeds { nothing, flat_state, flat_state_with_drag };
  /// Return the flat state that demand() uses.
  virtual Feeds feeds() const { return Feeds::nothing; }
  /// Return the demand on the rotors until the next call.
  /// \param memory  ControllerInfo::memory_size numbers
  virtual Demand demand(const ControllerInput& input, double* memory) const = 0;
  /// Return the controller for the lanes of a batch, or null if it is only for single vehicles.
  virtual std::shared_ptr<const LaneWrenchController> in_lanes(double /*period*/) const {
    return nullptr;
  }
};

/// A controller that users can choose.
struct ControllerInfo {
  std::string name;            ///< name of the controller
  std::string summary;         ///< one line
  std::vector<TagSpec> table;  ///< parameters of its WrenchController
  std::size_t memory_size;     ///< number of memory values
  Values
      defaults;  ///< defaults of these and of Controller's parameters that differ from the tables
  /// Creates the WrenchController from checked values. Throws InputError if they give no gains.
  std::function<std::unique_ptr<WrenchController>(const ModelledVehicle&, const Values&)> make;
};

/// Describe a controller whose WrenchController has class L, which is created from a model and its
/// gains.
template <class L>
ControllerInfo make_info(const std::string& name, const std::string& summary,
                         const Values& defaults = {}) {
  return {name,
          summary,
          table_of(L::settings()),
          L::memory_size,
          defaults,
          [](const ModelledVehicle& model, const Values& values) {
            typename L::Gains gains{};
            configure(gains, L::settings(), values);
            return std::make_unique<L>(model, gains);
          }};
}

/// Return all built-in controllers.
const std::vector<ControllerInfo>& list_controllers();
/// Return a controller by name. Throws InputError with the names of all controllers.
const ControllerInfo& find_controller(const std::string& name);

}  // namespace control
}  // namespace quadcore
