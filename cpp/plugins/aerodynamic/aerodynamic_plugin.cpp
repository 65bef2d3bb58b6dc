#include <algorithm>
#include <cmath>
#include <string>

#include "configuration.hpp"
#include "effectiveness.hpp"
#include "lanes/for_each_width.hpp"
#include "law_tags.hpp"
#include "quadcore/force_laws.hpp"
#include "quadcore/lane_width.hpp"
#include "quadcore/law_interface.hpp"
#include "quadcore/plugin.hpp"
#include "quadcore/plugin/error.hpp"
#include "shown_motion.hpp"

namespace quadcore::aerodynamic {
namespace {

/// Which warnings this flight has heard, behind the shares; filled up to a whole block, so that the
/// tables of other plugins begin where a pack can be read at once.
enum Memory { kDriven, kUnfelt, kAliased, kMemorySize = widest_lanes - 1 };

/// rad
constexpr double surely_below_half_a_turn = 3;

/// A model made for the thesis' plugin flies another vehicle without the drag compiled in there.
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
      "no drag is set, so that nothing slows the vehicle; the thesis' plugin (A.5) had " + values +
      " compiled in: write these tags, or one of them with 0 to fly without drag");
}

/// What a joint hands on must reach the frame.
void refuse_rotors_on_rotors(const PluginSetup& setup, const Config& config) {
  for (const std::size_t i : config.rotors) {
    const Joint& joint = setup.model.joints[i];
    if (joint.parent == 0) continue;
    throw InputError("<reactionOn> rotor: joint '" + joint.name + "' (" + joint.where +
                     ") hangs on a link that moves; write frame, or hang it on the frame");
  }
}

/// The laws take the propeller's z for up.
void warn_of_axes_against_lift(const PluginSetup& setup, const Config& config) {
  for (const std::size_t i : config.rotors) {
    const Joint& joint = setup.model.joints[i];
    if (joint.axis.z() >= 0) continue;
    setup.warnings.push_back(
        "joint '" + joint.name + "' (" + joint.where + ") has its axis against the z of link '" +
        setup.model.links[i + 1].name + "', so that " +
        (config.appendix ? "its reaction torque takes the wrong sign" : "its thrust points down") +
        "; write the axis along the lift and give the sense of rotation by the sign of the "
        "command");
  }
}

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
    add_ = widths[lane_width(setup.model.joints.size())];
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

  /// The thesis' plugin falls silent for a rotor that turns more than half a turn per step. Here
  /// such a speed ends the flight of an engine that turns rotors by hinges; others warn.
  void update(const Sample& sample, PluginState state) const override {
    effectiveness_.follow(sample, state);
    auto memory = state.tail<kMemorySize>();
    if (!sample.kinematics.rotors.slower_than(surely_below_half_a_turn / sample.dt))
      look_for_half_turns(sample, memory[kAliased]);
    if (memory[kUnfelt] == 0 && config_.appendix && !sample.kinematics.v_WA_F.isZero(0)) {
      memory[kUnfelt] = 1;
      sample.warnings.push_back(
          "the air moves, and <dragModel> appendix feels nothing of it, as in the thesis; set "
          "<dragModel> to chapter2 for a flight in wind");
    }
    if (memory[kDriven] == 0 && drag_drives(sample.kinematics)) {
      memory[kDriven] = 1;
      sample.warnings.push_back(
          "a propeller tilts beyond 90 degrees, where the parasitic drag of <dragModel> appendix "
          "drives the vehicle with the square of its speed instead of slowing it; set <dragModel> "
          "to chapter2, or <parasiticDragCoeff> to 0, for such a flight");
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
  }

  void laws(ConstPluginState state, ForceLaws& laws) const override {
    laws.rotor_forces.push_back(config_.summed());
    laws.rotor_forces.back().shares = state.data();  // as they are once a step has begun
    const double* const memory = state.data() + effectiveness_.size();
    laws.quiet.push_back({fastest_, drag_may_drive(),
                          follows_any_turn_ ? memory + kAliased : nullptr, memory + kDriven});
    if (config_.frame_drag != 0) laws.frame_drags.push_back({config_.frame_drag});
  }

 private:
  RotorForces with_shares(RotorForces law, ConstPluginState state) const {
    law.shares = effectiveness_.in_force(state);
    return law;
  }

  /// The same loads, rotor by rotor and law by law.
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
        throw FlightError(sample.time, what + "; take a smaller step or a slower command");
      }
      has_warned = 1;
      sample.warnings.push_back(
          what +
          ", so that its angles from step to step do not show its sense of rotation; take a "
          "smaller step if you need them");
      return;
    }
  }

  /// Whether any rotor has the parasitic drag of appendix A.5.
  bool drag_may_drive() const {
    return config_.summed().acting >> RotorLaws::place_of<laws::ParasiticDrag>() & 1;
  }

  /// Whether the vertical part of that drag points along the motion.
  bool drag_drives(const Kinematics& kinematics) const {
    if (!drag_may_drive()) return false;
    const Vector3d up_F = kinematics.R_WF.row(2);
    return std::any_of(config_.rotors.begin(), config_.rotors.end(), [&](std::size_t i) {
      return up_F.dot(kinematics.rotors.vector(MotionRow::normal, i)) < 0;
    });
  }

  Config config_;
  std::vector<std::string> joint_names_;
  double fastest_;  ///< rate of a joint below which update() does not look at it [rad/s]
  bool follows_any_turn_;
  Effectiveness effectiveness_;
  void (*add_)(const RotorForces&, const ShownMotion&);
};

PluginDescriptor describe() {
  using T = TagSpec;
  const std::string no_effect = "the thesis' tag, without effect there and here";
  return {
      "thrust, reaction torque and drag of the rotors (thesis eqs. 2.10-2.32, appendix A.5)",
      tags_of_laws_and({
          T::number("sim_slow", "", "1",
                    "rotors turn this much slower in the engine than the forces assume")
              .above(0)
              .from("chapter 4")
              .agreed(),
          T::choice("dragModel", {"appendix", "chapter2"},
                    "forces as the thesis' plugin computes them, or as its chapter 2 says; the "
                    "parasitic drag of appendix drives a vehicle tilted beyond 90 degrees, and it "
                    "feels no wind")
              .from("A.5, (2.28)-(2.31)"),
          T::number("airDensity", "kg/m^3", "",
                    "density of the air for which the thrust, torque and drag coefficients are: "
                    "they become those of the world's <atmosphere> at z = 0")
              .above(0)
              .or_absent("they hold as they are"),
          T::choice(
              "reactionTorque", {"thesis", "opposing"},
              "sign of the reaction torque: with the rotor's spin as in the thesis, or against")
              .from("(2.11), (2.13)"),
          T::choice("reactionOn", {"frame", "rotor"},
                    "what the reaction torque acts on: the frame as in the thesis, or the rotors, "
                    "which the air brakes and whose motors hand it on; they coast to a stop, and "
                    "it always opposes the spin")
              .from("(2.11)"),
          T::link("frameLink", "link that takes the reaction torque; part of the root body"),
          T::joints("rotorJoints", "the rotors"),
          T::text("effectiveness", "effectiveness",
                  "topic: of each rotor the share of thrust and reaction torque that is left, 1 "
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
