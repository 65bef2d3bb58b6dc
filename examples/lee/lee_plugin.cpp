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

/// The controller of lee.py: Lee, Leok, McClamroch 2010, "Geometric tracking control of a quadrotor
/// UAV on SE(3)", equations (10), (11), (15) and (16).
class LeePlugin final : public quadcore::Plugin {
 public:
  explicit LeePlugin(const quadcore::PluginSetup& setup) {
    const quadcore::Parameters& p = setup.parameters;
    kx_ = p.number("kx");
    kv_ = p.number("kv");
    kr_ = Vector3d(p.number("kr"), p.number("kr"), p.number("kr_yaw"));
    kw_ = Vector3d(p.number("kw"), p.number("kw"), p.number("kw_yaw"));
    odometry_ = setup.topics.takes("odom", messages::kind_of<messages::Odometry>());
    reference_ = setup.topics.takes("reference", messages::kind_of<messages::Reference>());
    command_ = setup.topics.publishes("vel_cmd", messages::speeds(setup.model.joints.size()));
  }

  void prepare(const quadcore::VehicleDescription& vehicle) override {
    belief_ = control::ModelledVehicle::of(vehicle, {}, {});
    allocation_.emplace(*belief_);
  }

  void update(const quadcore::Sample& sample, quadcore::PluginState) const override {
    if (sample.topics[odometry_].count == 0 || sample.topics[reference_].count == 0) return;
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
    const Vector3d f_W = belief_->mass * (kx_ * (wanted.position - now.position) +
                                          kv_ * (wanted.velocity - now.linear_velocity) +
                                          wanted.acceleration + Vector3d(0, 0, belief_->gravity));
    const Matrix3d R = now.orientation.toRotationMatrix();
    const Matrix3d R_d = attitude(f_W, wanted.yaw);
    const Vector3d turn_d = R_d.transpose() * wanted.jerk * (belief_->mass / f_W.norm());
    const Vector3d w_d(-turn_d.y(), turn_d.x(), wanted.yaw_rate * R_d(2, 2));
    const Matrix3d E = R_d.transpose() * R;
    const Vector3d error = 0.5 * Vector3d(E(2, 1) - E(1, 2), E(0, 2) - E(2, 0), E(1, 0) - E(0, 1));
    const Vector3d& w = now.angular_velocity;
    const Vector3d turn = -kr_.cwiseProduct(error) - kw_.cwiseProduct(w - E.transpose() * w_d);
    const Matrix3d& inertia = belief_->inertia_Ccm_F;
    return {f_W.dot(R.col(2)), inertia * turn + w.cross(inertia * w)};
  }

  /// Attitude whose z axis points along the force, with a heading.
  static Matrix3d attitude(const Vector3d& f_W, double yaw) {
    const Vector3d z = f_W.normalized();
    const auto [sine, cosine] = quadcore::elementary::sincos(yaw);
    const Vector3d y = z.cross(Vector3d(cosine, sine, 0)).normalized();
    Matrix3d R;
    R << y.cross(z), y, z;
    return R;
  }

  double kx_, kv_;
  Vector3d kr_, kw_;
  std::size_t odometry_, reference_, command_;
  std::optional<control::ModelledVehicle> belief_;
  std::optional<control::Allocation> allocation_;
};

quadcore::PluginDescriptor describe() {
  using T = quadcore::TagSpec;
  return {"Lee's geometric controller",
          {
              T::number("kx", "1/s^2", "6", "gain of the position error").at_least(0),
              T::number("kv", "1/s", "4", "gain of the velocity error").at_least(0),
              T::number("kr", "1/s^2", "80", "gain of the tilt error").at_least(0),
              T::number("kw", "1/s", "16", "gain of the roll and pitch rates").at_least(0),
              T::number("kr_yaw", "1/s^2", "2", "gain of the yaw error").at_least(0),
              T::number("kw_yaw", "1/s", "3", "gain of the yaw rate").at_least(0),
          },
          {},
          quadcore::create<LeePlugin>};
}

}  // namespace

QUADCORE_REGISTER_PLUGIN(describe)
