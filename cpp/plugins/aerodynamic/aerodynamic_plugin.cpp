#include <algorithm>
#include <cmath>
#include <string>

#include "add_rotor_forces.hpp"
#include "configuration.hpp"
#include "effectiveness.hpp"
#include "lanes/for_each_width.hpp"
#include "law_tags.hpp"
#include "quadcore/force_laws.hpp"
#include "quadcore/lane_width.hpp"
#include "quadcore/law_interface.hpp"
#include "quadcore/plugin.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::aerodynamic {
namespace {

/// Warnings already given in this flight, stored after the fractions. They are padded to a whole
/// block, so that the tables of other plugins remain aligned.
enum Memory { kDriven, kIgnoresWind, kAliased, kMemorySize = widest_lanes - 1 };

/// rad
constexpr double surely_below_half_a_turn = 3;

/// Warn about missing drag tags: the thesis' plugin has the drag compiled in.
void warn_without_drag(const PluginSetup& setup) {
  std::string values;
  bool is_set = false;
  for_each_tag([&](const laws::Tag& tag) {
    if (!tag.compiled_in) return;
    is_set |= setup.parameters.is_set(tag.name);
    values += (values.empty() ? "<" : ", <") + std::string(tag.name) + ">" + tag.compiled_in;
  });
  if (is_set) return;
  setup.warnings.push_back(
      "no drag is set, so nothing slows the vehicle down. The thesis' plugin (A.5) had " + values +
      " compiled in. Write these tags, or one of them with 0 to simulate without drag.");
}

/// Reject joints whose reaction cannot reach the frame.
void refuse_rotors_on_rotors(const PluginSetup& setup, const Config& config) {
  for (const std::size_t i : config.rotors) {
    const Joint& joint = setup.model.joints[i];
    if (joint.parent == 0) continue;
    throw InputError(
        "<reactionOn> rotor: joint '" + joint.name + "' (" + joint.where +
        ") is attached to a moving link. Use frame, or attach the joint to the frame.");
  }
}

/// Warn about axes opposite to the propeller's z, which the force laws take as up.
void warn_of_axes_against_lift(const PluginSetup& setup, const Config& config) {
  for (const std::size_t i : config.rotors) {
    const Joint& joint = setup.model.joints[i];
    if (joint.axis.z() >= 0) continue;
    setup.warnings.push_back(
        "joint '" + joint.name + "' (" + joint.where +
        ") has its axis opposite to the z of link '" + setup.model.links[i + 1].name + "', so " +
        (config.appendix ? "its reaction torque has the wrong sign" : "its thrust points down") +
        ". Point the axis along the thrust and set the direction of rotation by the sign of the "
        "command");
  }
}

using laws::ShownMotion;
using laws::ShownPack;
using laws::Vec3;

Vec3<double> components(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Vector3d vector(const Vec3<double>& v) { return {v.x, v.y, v.z}; }

class AerodynamicPlugin final : public Plugin {
 public:
  static constexpr const char* law_interface = quadcore::law_interface;

  explicit AerodynamicPlugin(const PluginSetup& setup)
      : config_(setup.parameters, setup.model.joints.size(), setup.world.atmosphere),
        joint_names_(setup.model.joint_names()),
        fastest_(surely_below_half_a_turn / setup.dt),
        follows_any_turn_(setup.follows_any_turn),
        effectiveness_(setup, config_.rotors) {
    static constexpr laws::ForEachWidth<void(const RotorForces&, const ShownMotion&)> widths{
        &add_rotor_forces<1>, &add_rotor_forces<2>, &add_rotor_forces<4>, &add_rotor_forces<8>};
    add_ = widths[lane_width()];
    if (config_.on_rotor) refuse_rotors_on_rotors(setup, config_);
    warn_without_drag(setup);
    warn_of_axes_against_lift(setup, config_);
  }

  std::size_t state_size() const override {
    return static_cast<std::size_t>(effectiveness_.size()) + kMemorySize;
  }

  void describe_rotors(std::vector<RotorDescription>& rotors) const override {
    for (const std::size_t i : config_.rotors) rotors[i].slowdown = config_.sim_slow;
  }

  /// The thesis' plugin stops working for a rotor that turns more than half a turn per step. Here,
  /// such a speed ends the flight in engines with hinged rotors; the others warn.
  void update(const Sample& sample, PluginState state) const override {
    effectiveness_.follow(sample, state);
    auto memory = state.tail<kMemorySize>();
    if (!sample.kinematics.rotors.slower_than(surely_below_half_a_turn / sample.dt))
      look_for_half_turns(sample, memory[kAliased]);
    if (memory[kIgnoresWind] == 0 && config_.appendix && !sample.kinematics.v_WA_F.isZero(0)) {
      memory[kIgnoresWind] = 1;
      sample.warnings.push_back(
          "the air moves, but <dragModel> appendix ignores wind, as in the thesis. Set <dragModel> "
          "to chapter2 for a flight in wind.");
    }
    if (memory[kDriven] == 0 && drag_drives(sample.kinematics)) {
      memory[kDriven] = 1;
      sample.warnings.push_back(
          "a propeller tilts beyond 90 degrees, where the parasitic drag of <dragModel> appendix "
          "accelerates the vehicle instead of slowing it down. Set <dragModel> to chapter2, or "
          "<parasiticDragCoeff> to 0, for such a flight.");
    }
  }

  void forces(const Kinematics& kinematics, ConstPluginState state, Loads& loads) const override {
    const ShownMotion shown{{kinematics.rotors.data(), loads.rotors().data(),
                             kinematics.rotors.size(), kinematics.has_rotations()},
                            kinematics.numbers()};
    if (loads.terms()) {
      record(with_shares(config_.separate(), state), shown, loads);
    } else {
      add_(with_shares(config_.summed(), state), shown);
    }
    if (config_.frame_drag != 0) {
      const Vector3d v_ACcm_F = kinematics.v_WCcm_F - kinematics.v_WA_F;
      loads.add_frame_force(
          RotorLaws::place_of<laws::ParasiticDrag>(),
          vector(laws::parasitic_drag(components(v_ACcm_F), v_ACcm_F.norm(), config_.frame_drag)),
          kinematics.p_FCcm_F);
    }
    if (config_.has_airframe) add_airframe(kinematics, loads);
  }

  void laws(ConstPluginState state, ForceLaws& laws) const override {
    laws.rotor_forces.push_back(config_.summed());
    laws.rotor_forces.back().shares = state.data();  // valid once a step has begun
    const double* const memory = state.data() + effectiveness_.size();
    laws.quiet.push_back({fastest_, drag_may_drive(),
                          follows_any_turn_ ? memory + kAliased : nullptr, memory + kDriven});
    if (config_.frame_drag != 0) laws.frame_drags.push_back({config_.frame_drag});
    if (config_.has_airframe) laws.airframes.push_back({config_.airframe.data()});
  }

 private:
  RotorForces with_shares(RotorForces law, ConstPluginState state) const {
    law.shares = effectiveness_.in_force(state);
    return law;
  }

  /// Add the airframe's other laws. They belong to the term of its parasitic drag.
  void add_airframe(const Kinematics& kinematics, Loads& loads) const {
    const auto k = [&](std::size_t row) { return config_.airframe[row]; };
    const Vec3<double> V_F = components(kinematics.v_WCcm_F - kinematics.v_WA_F);
    const std::size_t term = RotorLaws::place_of<laws::ParasiticDrag>();
    loads.add_frame_force(term, vector(laws::airframe_force(k, V_F)), kinematics.p_FCcm_F);
    loads.add_frame_torque(term,
                           vector(laws::airframe_torque(k, V_F, components(kinematics.w_WF_F))));
  }

  /// Add the same loads rotor by rotor and law by law.
  void record(const RotorForces& law, const ShownMotion& shown, Loads& loads) const {
    for (const std::size_t i : config_.rotors) {
      const ShownPack<double> motion{shown, i};
      const laws::LawsOfRotors<double> of_rotor = laws::laws_of_rotors<double>(law, i);
      const laws::RotorDisc<double> disc = laws::disc_of(of_rotor, motion);
      const auto add = [&](const auto& one, std::size_t term) {
        if constexpr (std::decay_t<decltype(one)>::effect == laws::Effect::reaction_torque) {
          laws::RotorLoads<double> reaction{};
          laws::add_reaction(law.conventions, disc, motion, one.torque(disc), reaction);
          loads.add_frame_torque(term, vector(reaction.reaction_F));
          loads.add_joint_torque(i, reaction.joint_torque);
        } else {
          loads.add_rotor_force(term, i, vector(laws::force_F(one, disc, motion)));
        }
      };
      RotorLaws::for_each(law.acting, of_rotor.coefficients, add);
    }
  }

  void look_for_half_turns(const Sample& sample, double& has_warned) const {
    if (has_warned != 0) return;
    for (const std::size_t i : config_.rotors) {
      if (std::abs(sample.kinematics.rotors.number(MotionRow::rate, i)) * sample.dt <= M_PI)
        continue;
      const std::string what =
          "rotor '" + joint_names_[i] + "' turns more than half a turn per step";
      if (!follows_any_turn_) {
        throw FlightError(sample.time, what + ". Use a smaller step or a slower command.");
      }
      has_warned = 1;
      sample.warnings.push_back(what +
                                ", so its angles from step to step do not show its direction of "
                                "rotation. Use a smaller step if you need them.");
      return;
    }
  }

  /// Return whether any rotor has the parasitic drag of appendix A.5.
  bool drag_may_drive() const {
    return config_.summed().acting >> RotorLaws::place_of<laws::ParasiticDrag>() & 1;
  }

  /// Return whether the vertical part of that drag points along the motion.
  bool drag_drives(const Kinematics& kinematics) const {
    if (!drag_may_drive()) return false;
    const Vector3d up_F = kinematics.R_WF.row(2);
    return std::any_of(config_.rotors.begin(), config_.rotors.end(), [&](std::size_t i) {
      return up_F.dot(kinematics.rotors.vector(MotionRow::normal, i)) < 0;
    });
  }

  Config config_;
  std::vector<std::string> joint_names_;
  double fastest_;  ///< joint rate below which update() ignores the joint [rad/s]
  bool follows_any_turn_;
  Effectiveness effectiveness_;
  void (*add_)(const RotorForces&, const ShownMotion&);
};

PluginDescriptor describe() {
  using T = TagSpec;
  const std::string no_effect = "tag of the thesis; no effect there or here";
  return {
      "rotor aerodynamics: thrust, reaction torque and drag (thesis eqs. 2.10-2.32, appendix A.5)",
      tags_of_laws_and({
          T::number("sim_slow", "", "1",
                    "slowdown: factor by which the joints turn slower than the forces assume")
              .above(0)
              .from("chapter 4")
              .agreed(),
          T::choice("dragModel", {"appendix", "chapter2"},
                    "drag as in the thesis' plugin (appendix) or its chapter 2; appendix ignores "
                    "wind, and its parasitic drag accelerates a vehicle tilted beyond 90 degrees")
              .from("A.5, (2.28)-(2.31)"),
          T::number("airDensity", "kg/m^3", "",
                    "air density for which the thrust, torque and drag coefficients hold; they are "
                    "scaled to the world's <atmosphere> at z = 0")
              .above(0)
              .or_absent("not scaled"),
          T::choice("reactionTorque", {"thesis", "opposing"},
                    "sign of the reaction torque: along the rotor's spin as in the thesis, or "
                    "opposing it")
              .from("(2.11), (2.13)"),
          T::choice(
              "reactionOn", {"frame", "rotor"},
              "body that takes the reaction torque; the thesis has `frame`. With `rotor`, the "
              "torque opposes the spin, the motors transmit it to the frame, and unpowered "
              "rotors coast to a stop")
              .from("(2.11)"),
          T::numbers("rotorFactors", "", "",
                     "factor of thrust and reaction torque of each rotor, for damaged or unequal "
                     "propellers")
              .at_least(0)
              .scaling(Effect::thrust)
              .or_absent("1 for each"),
          T::link("frameLink", "link that takes the reaction torque; part of the root body"),
          T::joints("rotorJoints", "the rotors"),
          T::text("effectiveness", "effectiveness",
                  "topic with the remaining fraction of each rotor's thrust and reaction torque; 1 "
                  "before the first message"),
          T::number("updateRate", "1/s", "", no_effect).at_least(0).or_absent("no effect"),
          T::flag("publishTf", "false", no_effect),
      }),
      terms_of_laws(),
      create<AerodynamicPlugin>,
  };
}

}  // namespace
}  // namespace quadcore::aerodynamic

QUADCORE_REGISTER_PLUGIN(quadcore::aerodynamic::describe)
