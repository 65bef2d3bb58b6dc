#include <algorithm>
#include <quadcore/plugin.hpp>

namespace {

using quadcore::TagSpec;
using quadcore::Vector3d;
namespace messages = quadcore::messages;

/// Tells what plugins are told, and pushes with the cube of the time.
class ProbePlugin final : public quadcore::Plugin {
 public:
  explicit ProbePlugin(const quadcore::PluginSetup& setup)
      : cube_(setup.parameters.number("cube")),
        gravity_W_(setup.world.gravity_W),
        air_(setup.topics.publishes("air", messages::kind_of<messages::Vector>())),
        seen_(setup.topics.publishes("seen", {"seen", {"time", "late", "g", "bits"}})) {
    std::vector<std::string> fields = {"mass", "cx", "cy", "cz", "g"};
    for (std::size_t i = 0; i < setup.model.joints.size(); ++i) {
      const std::string n = std::to_string(i + 1);
      for (const char* name : {"m", "px", "py", "pz", "ax", "ay", "az", "ox", "oy", "oz"}) {
        fields.push_back(name + n);
      }
      for (const char* sense : {"p", "n"}) {  // positive, negative
        for (const char* name : {"fx", "fy", "fz", "tx", "ty", "tz"}) {
          fields.push_back(name + (sense + n));
        }
      }
    }
    vehicle_ = setup.topics.publishes("vehicle", {"vehicle", fields});
  }

  void prepare(const quadcore::VehicleDescription& vehicle) override {
    const Vector3d& c = vehicle.body.p_FCcm;
    numbers_ = {vehicle.body.mass, c.x(), c.y(), c.z(), vehicle.gravity_W.z()};
    const auto add = [this](const Vector3d& v) {
      numbers_.insert(numbers_.end(), v.data(), v.data() + 3);
    };
    for (const quadcore::RotorDescription& rotor : vehicle.rotors) {
      numbers_.push_back(rotor.moment);
      add(rotor.p_FRcm_F);
      add(rotor.axis_F);
      add(rotor.p_FR_F);
      for (const quadcore::Wrench& wrench : {rotor.forward, rotor.backward}) {
        add(wrench.force_F);
        add(wrench.torque_F);
      }
    }
  }

  void sense(const quadcore::Sample& sample, quadcore::PluginState) const override {
    const quadcore::Kinematics& k = sample.kinematics;
    sample.topics.publish(air_, sample.time, messages::Vector{k.v_WA_F});
    const double seen[] = {k.time, k.time - sample.time,
                           gravity_W_.z() - sample.world.gravity_W.z(),
                           static_cast<double>(quadcore::random_bits(sample.seed, 0) >> 11)};
    std::copy(std::begin(seen), std::end(seen), sample.topics.publish(seen_, sample.time));
    std::copy(numbers_.begin(), numbers_.end(), sample.topics.publish(vehicle_, sample.time));
  }

  void forces(const quadcore::Kinematics& k, quadcore::ConstPluginState,
              quadcore::Loads& loads) const override {
    if (cube_ == 0) return;
    const double f = cube_ * k.time * k.time * k.time;
    loads.add_frame_force(0, k.R_WF.transpose() * Vector3d(f, 0, 0), k.p_FCcm_F);
  }

 private:
  double cube_;  ///< N/s^3
  Vector3d gravity_W_;
  std::size_t air_, seen_, vehicle_ = 0;
  std::vector<double> numbers_;
};

quadcore::PluginDescriptor describe() {
  return {"tells what plugins are told",
          {TagSpec::number("cube", "N/s^3", "0", "of a force along the world's x")},
          {"cube"},
          quadcore::create<ProbePlugin>};
}

}  // namespace

QUADCORE_REGISTER_PLUGIN(describe)
