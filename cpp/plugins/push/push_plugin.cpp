#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "quadcore/plugin.hpp"
#include "quadcore/text.hpp"

namespace quadcore::push {
namespace {

/// A force and a torque.
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// State: the published push and the pushes of the tag that act in this step.
enum Memory { kPublished, kListed = kPublished + 6, kMemorySize = kListed + 6 };

/// A push of the tag.
struct Push {
  double begin, duration;  ///< s
  Vector6d wrench;

  bool acts(double time) const {  // the time is a sum of steps
    return time >= begin - 1e-9 && time < begin + duration - 1e-9;
  }

  /// Number of values of one push in the tag.
  static constexpr std::size_t numbers = 8;
  static std::vector<Push> all(const Parameters& p) {
    const std::vector<double>& n = p.numbers("pushes");
    if (n.size() % numbers != 0) {
      throw InputError(
          "<pushes> has " + std::to_string(n.size()) +
          " numbers. Write eight for each push: start, duration, force (3) and torque (3).");
    }
    std::vector<Push> pushes;
    for (auto i = n.begin(); i != n.end(); i += numbers) {
      Push push{i[0], i[1], {}};
      std::copy_n(i + 2, 6, push.wrench.data());
      if (push.begin < 0 || push.duration <= 0) {
        throw InputError("push " + std::to_string(pushes.size() + 1) +
                         " of <pushes> starts before the flight or has no duration. Use a start >= "
                         "0 and a duration > 0.");
      }
      pushes.push_back(push);
    }
    return pushes;
  }
};

/// A force at a point of a link and a torque, from a topic or a tag.
class PushPlugin final : public Plugin {
 public:
  explicit PushPlugin(const PluginSetup& setup)
      : in_world_(setup.parameters.choice("axes") == "world"),
        duration_(setup.parameters.has("duration") ? setup.parameters.number("duration")
                                                   : INFINITY),
        pushes_(Push::all(setup.parameters)),
        topic_(setup.topics.takes(setup.parameters.text("topic"),
                                  messages::kind_of<messages::Wrench>())) {
    const Model& model = setup.model;
    const std::string link =
        setup.parameters.has("link") ? setup.parameters.text("link") : model.links.front().name;
    const auto body = model.body_of_link.find(link);
    if (body == model.body_of_link.end()) {
      std::vector<std::string> names;
      for (const auto& entry : model.body_of_link) names.push_back(entry.first);
      throw InputError("<link> '" + link + "' is not a link of the model." + suggest(link, names) +
                       " The model has " + joined(names) + ".");
    }
    const Pose& X_BL = model.pose_of_link.at(link);
    R_BL_ = X_BL.rotation().toRotationMatrix();
    p_BQ_B_ = X_BL.xyz + R_BL_ * Vector3d(setup.parameters.numbers("xyz").data());
    if (body->second == 0) return;
    rotor_ = body->second - 1;
    p_BQ_B_ -= model.links[body->second].inertial.pose.xyz;
  }

  std::size_t state_size() const override { return kMemorySize; }

  void update(const Sample& sample, PluginState state) const override {
    state.setZero();
    const Topic& said = sample.topics[topic_];
    const double age = sample.time - said.stamp;  // negative after the time was set back
    if (said.count > 0 && age > -1e-9 && age < duration_ - 1e-9) {
      const auto push = sample.topics.read<messages::Wrench>(topic_);
      state.segment<6>(kPublished) << push.force, push.torque;
    }
    state.segment<6>(kListed) = listed(sample.time);
  }

  void forces(const Kinematics& k, ConstPluginState state, Loads& loads) const override {
    // A push that acts at the start of a step acts during the whole step; a row of a log shows the
    // push that acts from there on.
    const Vector6d wrench =
        state.segment<6>(kPublished) + (loads.terms() ? listed(k.time) : state.segment<6>(kListed));
    if (wrench.isZero(0)) return;
    const Matrix3d R_FB = rotor_ ? k.R_FR(*rotor_) : Matrix3d::Identity();
    const Matrix3d R_FA = in_world_ ? Matrix3d(k.R_WF.transpose()) : Matrix3d(R_FB * R_BL_);
    const Vector3d f_F = R_FA * wrench.head<3>();
    Vector3d tau_F = R_FA * wrench.tail<3>();
    if (!rotor_) {
      loads.add_frame_force(0, f_F, p_BQ_B_);
      loads.add_frame_torque(0, tau_F);
      return;
    }
    // The bearing transmits all torques across the rotor's axis to the frame; for the torque about
    // the axis, the joint's reaction cancels the part on the frame.
    tau_F += (R_FB * p_BQ_B_).cross(f_F);
    loads.add_rotor_force(0, *rotor_, f_F);
    loads.add_frame_torque(0, tau_F);
    loads.add_joint_torque(*rotor_, tau_F.dot(k.rotors[*rotor_].axis_F));
  }

 private:
  Vector6d listed(double time) const {
    Vector6d sum = Vector6d::Zero();
    for (const Push& push : pushes_) {
      if (push.acts(time)) sum += push.wrench;
    }
    return sum;
  }

  bool in_world_;
  double duration_;  ///< s
  std::vector<Push> pushes_;
  std::size_t topic_;
  std::optional<std::size_t> rotor_;  ///< rotor that carries the link; none: the frame
  Matrix3d R_BL_;                     ///< orientation of the link in the body that carries it
  Vector3d p_BQ_B_;                   ///< the point, from the frame's origin or the rotor's centre
                                      ///< of mass [m]
};

PluginDescriptor describe() {
  using T = TagSpec;
  return {
      "push: a force at a point of a link and a torque, by time or from a topic",
      {
          T::text("link", "", "link on which the push acts; may belong to a rotor")
              .or_absent("the root"),
          T::numbers("xyz", "m", "0 0 0", "point where the force acts, in the link's axes").of(3),
          T::choice("axes", {"world", "link"}, "axes of the force and the torque"),
          T::number("duration", "s", "", "duration of the push from a message")
              .above(0)
              .or_absent("until the next one"),
          T::numbers("pushes", "s s N N N N m N m N m", "",
                     "eight numbers for each push: start, duration, force and torque")
              .or_absent("none"),
          T::text("topic", "push", "topic from which force and torque are read"),
      },
      {"push"},
      create<PushPlugin>,
      true,
  };
}

}  // namespace
}  // namespace quadcore::push

QUADCORE_REGISTER_PLUGIN(quadcore::push::describe)
