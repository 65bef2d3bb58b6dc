#include "quadcore/control/guided_controller.hpp"

#include <optional>
#include <utility>

#include "flat_table.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/rotor_shares.hpp"

namespace quadcore::control {
namespace {

/// Number of values of an odometry message.
std::size_t count_fields() {
  std::size_t count = 0;
  Odometry any;
  Odometry::for_each_field(
      any, [&count](const char*, messages::Names names, const double*) { count += names.size(); });
  return count;
}

}  // namespace

GuidedController::GuidedController(const Simulation& simulation, Controller controller,
                                   const VehicleDescription& flown)
    : simulation_(simulation),
      controller_(std::move(controller)),
      preview_(controller_),
      health_of_(flown),
      health_(simulation.topics().find(health_topic)),
      state_(controller_.state_size()) {}

std::size_t GuidedController::find_odometry(const Topics& topics, const std::string& name) {
  static const std::size_t fields = count_fields();
  const std::size_t topic = topics.at(name);
  const MessageKind& kind = topics[topic].kind;
  if (kind.name != Odometry::kind || kind.fields.size() != fields) {
    throw InputError("topic '" + name + "' does not carry odometry. Name an odometry topic.");
  }
  return topic;
}

void GuidedController::command(double period, std::size_t odometry, const ReferenceShape& reference,
                               const ReferencePreview::ListTimes& list_times, double* speeds) {
  const double* const now = simulation_.topics()[odometry].values.data();
  const ReferencePreview::Point& point = preview_.at(simulation_.time(), reference, list_times);
  hear_of_health();
  double* const state = state_.data();
  const bool is_defined = point.flat || controller_.feeds() == WrenchController::Feeds::nothing;
  const bool is_whole = health_ < 0 || controller_.has_whole_rotors(state);
  if (is_defined && is_whole && single_lane_.prepare(period, controller_, state)) {
    return single_lane_.command(controller_, now, point, state, speeds);
  }
  const std::optional<FlatState> flat = point.flat_state();
  controller_.command(period, messages::read<Odometry>(now), point.wanted, state, speeds,
                      flat ? &*flat : nullptr);
}

void GuidedController::command(double period, const Odometry& now, const Reference& wanted,
                               double* speeds) {
  hear_of_health();
  controller_.command(period, now, wanted, state_.data(), speeds);
}

void GuidedController::hear_of_health() {
  if (health_ < 0) return;
  const Topic& health = simulation_.topics()[static_cast<std::size_t>(health_)];
  health_of_.update(health, simulation_.time(), controller_, state_.data());
}

}  // namespace quadcore::control
