#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "quadcore/force_laws.hpp"
#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/plugin/loads.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/world.hpp"
#include "quadcore/state.hpp"

namespace quadcore QUADCORE_EXPORT {

/// The air velocity and the force laws of all plugins: a pure function of time and motion that an
/// engine may evaluate as often as its integrator requires.
class ForceField {
 public:
  virtual ~ForceField() = default;
  /// Set the air velocity in `kinematics`, in which the caller has set time and motion, and add to
  /// `loads`, which the caller has cleared.
  virtual void evaluate(Kinematics& kinematics, Loads& loads) const = 0;
  /// Return the part of evaluate() that an engine may evaluate itself, at each stage of a step.
  virtual const ForceLaws& laws() const;
  /// Evaluate the rest of evaluate(), which is required unless laws() are complete.
  virtual void evaluate_rest(Kinematics& kinematics, Loads& loads) const {
    evaluate(kinematics, loads);
  }
  /// Throw Error because the loads of evaluate() are not finite.
  [[noreturn]] virtual void refuse(const Kinematics& kinematics, Loads& loads) const;
};

/// Integrates the motion of a vehicle. The engine models gravity, joint damping and inertia;
/// everything else comes from the force field.
class Engine {
 public:
  virtual ~Engine() = default;

  /// Return the model as this engine simulates it (gazebo11 rounds its numbers).
  virtual const Model& model() const = 0;
  /// Advance by dt from a time [s], without memory allocation.
  virtual void step(double time, double dt, const ForceField& forces) = 0;
  /// Return the present motion. The caller sets its time and air velocity.
  virtual Kinematics& kinematics() = 0;
  /// Write the present state, except `state.time`.
  void get_state(VehicleState& state);
  /// The same without the joint angles, which take an arc tangent each in `gazebo11`.
  void get_motion(VehicleState& state);
  /// Set the state; `state.time` is ignored.
  virtual void set_state(const VehicleState& state) = 0;

  /// Return the complete internal state.
  virtual std::vector<double> save() const = 0;
  /// Restore the result of save(). Throws InputError if it belongs to another model or engine.
  virtual void restore(const std::vector<double>& saved) = 0;

  /// Return the integration method in one line.
  virtual std::string method() const = 0;
  /// Return the present motion of the world's free bodies.
  virtual std::vector<FreeBodyState> free_bodies() const { return {}; }
  /// Return warnings about model and world, starting with FILE:LINE.
  virtual std::vector<std::string> warnings() const { return {}; }
};

/// The engines of several vehicles in one world, which this class advances each by itself; derived
/// classes also simulate contact between them.
class SharedWorld {
 public:
  /// The engines must outlive this object.
  explicit SharedWorld(std::vector<Engine*> engines) : engines_(std::move(engines)) {}
  virtual ~SharedWorld() = default;

  /// The force field of a vehicle, and the time at which its step starts [s].
  struct TimedForces {
    double time;              ///< [s]
    const ForceField* field;  ///< of the vehicle
  };
  /// Advance all vehicles by dt.
  virtual void step(double dt, const std::vector<TimedForces>& forces);
  /// Return the index of the vehicle that step() works on, for errors.
  std::size_t current() const { return current_; }

  /// Return the present motion of the world's free bodies.
  virtual std::vector<FreeBodyState> free_bodies() const { return {}; }
  /// Return the complete internal state of everything but the engines.
  virtual std::vector<double> save() const { return {}; }
  /// Restore the result of save(). Throws InputError if it belongs to another world.
  virtual void restore(const std::vector<double>& saved);
  /// Return warnings about the vehicles together.
  virtual std::vector<std::string> warnings() const;

 protected:
  std::size_t current_ = 0;  ///< result of current()

 private:
  std::vector<Engine*> engines_;
};

/// An engine that users can choose.
struct EngineInfo {
  std::string name;     ///< value of SimulationOptions::engine
  std::string summary;  ///< one line
  /// Stability limit of r dt for a decay at rate r.
  double largest_decay_per_step;
  /// Whether a rotor may turn by any angle in a step, instead of at most half a turn.
  bool follows_any_turn;
};

/// Return all engines, the default first.
std::vector<EngineInfo> engines();

/// Throws InputError on an unknown name.
const EngineInfo& engine_info(const std::string& name);

/// Throws InputError on an unknown name or a model or world that the engine cannot represent.
std::unique_ptr<Engine> make_engine(const std::string& name, const Model& model,
                                    const World& world);

/// Let vehicles share a world. Free bodies of the world move only here: the engines were made for
/// the world without them.
/// \param name  name of the engine that made all of `engines`, which must outlive the result
std::unique_ptr<SharedWorld> share_world(const std::string& name,
                                         const std::vector<Engine*>& engines, const World& world);

}  // namespace quadcore
