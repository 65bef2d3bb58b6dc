#include <algorithm>
#include <cmath>
#include <optional>
#include <quadcore/control/allocation.hpp>
#include <quadcore/control/modelled_vehicle.hpp>
#include <quadcore/plugin.hpp>

namespace {

using quadcore::Matrix3d;
using quadcore::Vector3d;
namespace control = quadcore::control;
namespace messages = quadcore::messages;

constexpr double rounding = 1e-6;  ///< of a period

/// Gives roll and pitch priority over yaw (Brescianini, D'Andrea 2018, "Tilt-prioritized
/// quadrocopter attitude control"): roll and pitch turn the shortest way to the desired thrust, and
/// a slower loop controls yaw.
class TiltControllerPlugin final : public quadcore::Plugin {
 public:
  explicit TiltControllerPlugin(const quadcore::PluginSetup& setup) {
    const quadcore::Parameters& p = setup.parameters;
    rate_ = p.number("rate");
    kp_ = p.number("kp");
    kd_ = p.number("kd");
    k_tilt_ = p.number("kTilt");
    k_rate_ = p.number("kRate");
    k_yaw_ = p.number("kYaw");
    k_yaw_rate_ = p.number("kYawRate");
    odometry_ = setup.topics.takes("odom", messages::kind_of<messages::Odometry>());
    reference_ = setup.topics.takes("reference", messages::kind_of<messages::Reference>());
    command_ = setup.topics.publishes("vel_cmd", messages::speeds(setup.model.joints.size()));
  }

  /// Steps simulated, and calls of the controller plus one.
  std::size_t state_size() const override { return 2; }

  void prepare(const quadcore::VehicleDescription& vehicle) override {
    belief_ = control::ModelledVehicle::of(vehicle, {}, {});
    allocation_.emplace(*belief_);
  }

  void update(const quadcore::Sample& sample, quadcore::PluginState state) const override {
    if (sample.topics[odometry_].count == 0 || sample.topics[reference_].count == 0) return;
    // Counts steps, because a sum of times accumulates rounding errors.
    const double due = std::floor(state[0] * rate_ * sample.dt + rounding) + 1;
    state[0] += 1;
    if (due <= state[1]) return;
    state[1] = due;
    const auto now = sample.topics.read<messages::Odometry>(odometry_);
    const auto wanted = sample.topics.read<messages::Reference>(reference_);
    double* const speeds = sample.topics.publish(command_, sample.time);
    allocation_->allocate(demand(now, wanted), speeds);
    for (std::size_t i = 0; i < belief_->rotors.size(); ++i) {
      speeds[i] = belief_->rotors[i].spin * std::sqrt(speeds[i]);
    }
  }

 private:
  control::Demand demand(const messages::Odometry& now, const messages::Reference& wanted) const {
    const Matrix3d R_WF = now.orientation.toRotationMatrix();
    const Vector3d gravity_W(0, 0, -belief_->gravity);
    const Vector3d f_W =
        belief_->mass * (wanted.acceleration + kp_ * (wanted.position - now.position) +
                         kd_ * (wanted.velocity - now.linear_velocity) - gravity_W);
    // The shortest rotation of the z axis of F to the desired thrust, as a rotation vector.
    const Vector3d z_wanted_F = R_WF.transpose() * f_W.normalized();
    const Vector3d across_F = Vector3d::UnitZ().cross(z_wanted_F);
    const double angle = quadcore::elementary::atan2(across_F.norm(), z_wanted_F.z());
    const Vector3d tilt_F = across_F.norm() > 0 ? (angle * across_F.normalized()).eval() : across_F;
    const double yaw = quadcore::elementary::atan2(R_WF(1, 0), R_WF(0, 0));
    const Vector3d& w_F = now.angular_velocity;
    Vector3d turn_F = k_tilt_ * tilt_F - k_rate_ * w_F;  // rad/s^2
    turn_F.z() = k_yaw_ * std::remainder(wanted.yaw - yaw, 2 * M_PI) +
                 k_yaw_rate_ * (wanted.yaw_rate - w_F.z());
    const Matrix3d& inertia = belief_->inertia_Ccm_F;
    return {f_W.dot(R_WF.col(2)), inertia * turn_F + w_F.cross(inertia * w_F)};
  }

  double rate_, kp_, kd_, k_tilt_, k_rate_, k_yaw_, k_yaw_rate_;
  std::size_t odometry_, reference_, command_;
  std::optional<control::ModelledVehicle> belief_;
  std::optional<control::Allocation> allocation_;
};

quadcore::PluginDescriptor describe() {
  using T = quadcore::TagSpec;
  return {"controller that gives roll and pitch priority over yaw",
          {
              T::number("rate", "1/s", "500", "calls per second").above(0),
              T::number("kp", "1/s^2", "9", "gain of the position error").at_least(0),
              T::number("kd", "1/s", "5.4", "gain of the velocity error").at_least(0),
              T::number("kTilt", "1/s^2", "120", "gain of the angle to the thrust").at_least(0),
              T::number("kRate", "1/s", "22", "gain of the roll and pitch rates").at_least(0),
              T::number("kYaw", "1/s^2", "2", "gain of yaw").at_least(0),
              T::number("kYawRate", "1/s", "3", "gain of the yaw rate").at_least(0),
          },
          {},
          quadcore::create<TiltControllerPlugin>};
}

}  // namespace

QUADCORE_REGISTER_PLUGIN(describe)
