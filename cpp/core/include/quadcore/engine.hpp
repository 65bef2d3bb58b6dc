#pragma once

#include <memory>
#include <string>
#include <vector>

#include "quadcore/force_laws.hpp"
#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/plugin/loads.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/world.hpp"
#include "quadcore/state.hpp"

namespace quadcore QUADCORE_EXPORT {

/// The air and the force laws of all plugins: a pure function of time and motion that an engine may
/// evaluate as often as its integrator needs.
class ForceField {
 public:
  virtual ~ForceField() = default;
  /// Puts the air's velocity into `kinematics`, whose time and motion the caller has filled, and
  /// adds to `loads`, which the caller has cleared.
  virtual void evaluate(Kinematics& kinematics, Loads& loads) const = 0;
  /// Part of evaluate() that an engine may evaluate itself, at each stage of a step.
  virtual const ForceLaws& laws() const;
  /// The rest of evaluate(), unless laws() are complete.
  virtual void evaluate_rest(Kinematics& kinematics, Loads& loads) const {
    evaluate(kinematics, loads);
  }
  /// Throws because what evaluate() added to `loads` is not finite.
  [[noreturn]] virtual void refuse(const Kinematics& kinematics, Loads& loads) const;
};

/// Moves a vehicle. Gravity, joint damping and inertial effects are the engine's; everything else
/// comes from the force field.
class Engine {
 public:
  virtual ~Engine() = default;

  /// The model as this engine flies it (gazebo11 rounds its numbers).
  virtual const Model& model() const = 0;
  /// Advances by dt from a time on [s]. Allocates nothing.
  virtual void step(double time, double dt, const ForceField& forces) = 0;
  /// The motion now. Its time and air are the caller's to write.
  virtual Kinematics& kinematics() = 0;
  /// The state now; `state.time` is left alone.
  virtual void get_state(VehicleState& state) const = 0;
  /// Moves the vehicle to a state; `state.time` is ignored.
  virtual void set_state(const VehicleState& state) = 0;

  /// Everything that the next steps depend on, bit for bit.
  virtual std::vector<double> save() const = 0;
  /// Goes on from what save() told. Throws InputError if that was of another model or engine.
  virtual void restore(const std::vector<double>& saved) = 0;

  /// How it takes its steps, in one line for a person.
  virtual std::string method() const = 0;
  /// What the author of model and world should know, FILE:LINE first.
  virtual std::vector<std::string> warnings() const { return {}; }
};

/// An engine, as users choose it.
struct EngineInfo {
  std::string name;     ///< as SimulationOptions::engine has it
  std::string summary;  ///< one line
  /// A decay at rate r is followed without growing while r dt is below this.
  double largest_decay_per_step;
  /// Whether a rotor may turn by any angle in a step. Otherwise it may turn by half a turn at most.
  bool follows_any_turn;
};

/// The engines there are, the default first.
std::vector<EngineInfo> engines();

/// Throws InputError on an unknown name.
const EngineInfo& engine_info(const std::string& name);

/// Throws InputError on an unknown name or a model or world that the engine cannot represent.
std::unique_ptr<Engine> make_engine(const std::string& name, const Model& model,
                                    const World& world);

}  // namespace quadcore
