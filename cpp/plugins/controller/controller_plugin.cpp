#include <algorithm>
#include <string>

#include "controller_setup.hpp"
#include "quadcore/control/rotor_health.hpp"
#include "quadcore/plugin.hpp"
#include "quadcore/rotor_shares.hpp"

namespace quadcore::controller {
namespace {

using control::Controller;
using control::ControllerSetup;

/// Runs a controller at its own rate: reads odometry and reference, and commands the rotors.
class ControllerPlugin final : public Plugin {
 public:
  explicit ControllerPlugin(const PluginSetup& setup)
      : setup_(setup.parameters),
        rotors_(setup.model.joints.size()),
        schedule_(setup_.schedule(rotors_)) {
    const Parameters& p = setup.parameters;
    odometry_ = setup.topics.takes(p.text("odometry"), messages::kind_of<messages::Odometry>());
    reference_ = setup.topics.takes(p.text("reference"), messages::kind_of<messages::Reference>());
    // One sample late, like a controller outside the simulation.
    health_ = setup.topics.takes(p.text("health"), shares(rotors_), true);
    command_ = setup.topics.publishes_as_taken(p.text("command"), messages::speeds(rotors_));
    const std::string& vehicle = setup_.gains.vehicle;
    if (!vehicle.empty() && vehicle != setup.model.name) {
      setup.warnings.push_back("the gains file " + p.text("gains") + " is for vehicle '" + vehicle +
                               "', but this vehicle is '" + setup.model.name +
                               "'. Check the gains.");
    }
  }

  std::size_t state_size() const override {
    return kSchedule + schedule_.state_size() + Controller::state_size(setup_.gains.law, rotors_);
  }

  void prepare(const VehicleDescription& vehicle) override {
    controller_ = std::make_unique<Controller>(setup_.controller(vehicle));
    health_of_ = std::make_unique<control::RotorHealth>(vehicle);
  }

  void update(const Sample& sample, PluginState state) const override {
    if (sample.topics[odometry_].count == 0 || sample.topics[reference_].count == 0) return;
    double* const own = state.data() + kSchedule;
    double* const laws = own + schedule_.state_size();
    health_of_->update(sample.topics[health_], sample.time, *controller_, laws);
    const auto ask = [&](double period, double* speeds) {
      const auto now = setup_.in_world(sample.topics.read<messages::Odometry>(odometry_));
      const auto wanted = sample.topics.read<messages::Reference>(reference_);
      controller_->command(period, now, wanted, laws, speeds);
    };
    const double* const speeds = schedule_.update(state[kSteps], sample.dt, own, ask);
    if (speeds) {
      double* const command = sample.topics.publish(command_, sample.time);
      std::copy_n(speeds, controller_->rotors(), command);
    }
    state[kSteps] += 1;
  }

 private:
  /// Number of steps; then the states of schedule and controller.
  enum Memory { kSteps, kSchedule };

  ControllerSetup setup_;
  std::size_t rotors_;  ///< number of joints, including those without a command
  control::Schedule schedule_;
  std::size_t odometry_, reference_, health_, command_;
  std::unique_ptr<const Controller> controller_;
  std::unique_ptr<const control::RotorHealth> health_of_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  std::vector<TagSpec> tags = ControllerSetup::tags();
  tags.insert(tags.end(),
              {T::text("odometry", "odom", "topic of the measured state"),
               T::text("reference", "reference", "topic of the reference"),
               T::text("health", health_topic,
                       "topic of the remaining rotor effectiveness known to the controller"),
               T::text("command", "vel_cmd", "topic of the commanded rotor speeds")});
  return {"runs a built-in controller", tags, {}, create<ControllerPlugin>};
}

}  // namespace
}  // namespace quadcore::controller

QUADCORE_REGISTER_PLUGIN(quadcore::controller::describe)
