#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/kinematics.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Force [N] and torque [N m], both in the frame's axes.
struct Wrench {
  // Apart, so that pairs of numbers that are cleared at once are the pairs that are read at once:
  // others stall.
  alignas(2 * sizeof(double)) Vector3d force_F = Vector3d::Zero();   ///< N
  alignas(2 * sizeof(double)) Vector3d torque_F = Vector3d::Zero();  ///< N m
};

/// The rate of a joint that is not left to torques: it is what it is said to be.
struct PrescribedRate {
  double at_end;        ///< of the step [rad/s]
  double slope;         ///< its derivative at the time of the motion [rad/s^2]
  bool reacts = false;  ///< whether what carries the rotor bears the torque that turns it
};

/// Collects what the force laws exert on the vehicle at one instant. All vectors are in the frame's
/// axes F. `term` is the index of the plugin's wrench term that the load belongs to (see
/// PluginDescriptor::wrenches); it matters only while a log records the terms one by one. An index
/// of a rotor or a term that is not there is an Error.
class Loads {
 public:
  /// For so many rotors, with nothing on any.
  explicit Loads(std::size_t rotor_count) : rotors_(rotor_count), rates_(rotor_count) {}

  /// A force on the frame at the point Q, p_FQ_F from the frame's origin.
  void add_frame_force(std::size_t term, const Vector3d& f_F, const Vector3d& p_FQ_F) {
    frame_.force_F += f_F;
    frame_.torque_F += p_FQ_F.cross(f_F);
    if (terms_) record(term, f_F, p_FQ_F);
  }
  /// A torque on the frame.
  void add_frame_torque(std::size_t term, const Vector3d& tau_F) {
    frame_.torque_F += tau_F;
    if (terms_) recorded(term).torque_F += tau_F;
  }
  /// A force on rotor i at its centre of mass.
  void add_rotor_force(std::size_t term, std::size_t i, const Vector3d& f_F) {
    check_rotor(i);
    rotors_.add_vector(LoadRow::force, i, f_F);
    if (terms_) record(term, f_F, kinematics_->rotors[i].p_FRcm_F);
  }
  /// A torque of joint i on its rotor about the joint axis; its reaction acts on the parent.
  void add_joint_torque(std::size_t i, double torque) {
    check_rotor(i);
    rotors_.number(LoadRow::joint_torque, i) += torque;
  }

  /// Gives joint i its rate; torques about it have no effect then. Throws Error if it has one
  /// already.
  void prescribe_joint_rate(std::size_t i, const PrescribedRate& rate) {
    check_rotor(i);
    if (rates_[i]) refuse_second_rate(i);
    rates_[i] = rate;
    any_rate_ = true;
  }

  /// What was put on the frame by itself, without the rotors' reactions; the torque is about the
  /// frame's origin.
  const Wrench& on_frame() const { return frame_; }
  /// The same with the rotors' reactions, summed in the rotors' order.
  Wrench frame() const;
  /// Force on rotor i at its centre of mass [N].
  Vector3d rotor_force_F(std::size_t i) const { return rotors_.vector(LoadRow::force, i); }
  /// Torque of joint i on its rotor about the joint axis [N m].
  double joint_torque(std::size_t i) const { return rotors_.number(LoadRow::joint_torque, i); }

  /// Whether any joint was given its rate.
  bool any_rate() const { return any_rate_; }
  /// The rate that joint i was given; nullopt where torques make it.
  const std::optional<PrescribedRate>& joint_rate(std::size_t i) const { return rates_[i]; }

  /// The rotors' loads for laws that take several rotors at once; what they add here belongs to no
  /// term.
  RotorRows<LoadRow::count>& rotors() { return rotors_; }
  /// The same to read.
  const RotorRows<LoadRow::count>& rotors() const { return rotors_; }

  /// Takes everything off the vehicle. What terms are recorded to is left alone.
  void clear();
  /// Clears all but rotors().
  void clear_rest();
  /// Whether no load and no prescribed rate is infinite or NaN.
  bool all_finite() const;
  /// While set, each load is also added to terms[term], about the vehicle's centre of mass.
  void record_terms(Wrench* terms, std::size_t count, const Kinematics* kinematics) {
    terms_ = terms;
    term_count_ = count;
    kinematics_ = kinematics;
  }
  /// The terms of the plugin that is evaluated next; null while nothing is recorded.
  Wrench* terms() const { return terms_; }

 private:
  void check_rotor(std::size_t i) const {
    if (i >= rotors_.rotors()) refuse_rotor(i);
  }
  [[noreturn]] void refuse_rotor(std::size_t i) const;
  [[noreturn]] void refuse_second_rate(std::size_t i) const;
  Wrench& recorded(std::size_t term);
  void record(std::size_t term, const Vector3d& f_F, const Vector3d& p_FQ_F);

  Wrench frame_;
  RotorRows<LoadRow::count> rotors_;
  std::vector<std::optional<PrescribedRate>> rates_;
  bool any_rate_ = false;
  Wrench* terms_ = nullptr;
  std::size_t term_count_ = 0;
  const Kinematics* kinematics_ = nullptr;
};

}  // namespace quadcore
