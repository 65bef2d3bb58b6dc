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

/// Prescribed rate of a joint, which replaces its equation of motion.
struct PrescribedRate {
  double at_end;        ///< rate at the end of the step [rad/s]
  double slope;         ///< derivative of the rate at the time of the motion [rad/s^2]
  bool reacts = false;  ///< whether the parent body takes the reaction to the rotor's acceleration
};

/// Sums the loads of all force laws on the vehicle at one instant. All vectors are in the frame's
/// axes F. `term` is the index of the plugin's wrench term for the load (see
/// PluginDescriptor::wrenches); it matters only while the terms are logged separately. Throws Error
/// for a rotor or term that does not exist.
class Loads {
 public:
  /// Create zero loads for so many rotors.
  explicit Loads(std::size_t rotor_count) : rotors_(rotor_count), rates_(rotor_count) {}

  /// Add a force on the frame at the point Q, located at p_FQ_F from the frame's origin.
  void add_frame_force(std::size_t term, const Vector3d& f_F, const Vector3d& p_FQ_F) {
    frame_.force_F += f_F;
    frame_.torque_F += p_FQ_F.cross(f_F);
    if (terms_) record(term, f_F, p_FQ_F);
  }
  /// Add a torque on the frame.
  void add_frame_torque(std::size_t term, const Vector3d& tau_F) {
    frame_.torque_F += tau_F;
    if (terms_) recorded(term).torque_F += tau_F;
  }
  /// Add a force on rotor i at its centre of mass.
  void add_rotor_force(std::size_t term, std::size_t i, const Vector3d& f_F) {
    check_rotor(i);
    rotors_.add_vector(LoadRow::force, i, f_F);
    if (terms_) record(term, f_F, kinematics_->rotors[i].p_FRcm_F);
  }
  /// Add a torque of joint i on its rotor about the joint axis. The reaction acts on the parent.
  void add_joint_torque(std::size_t i, double torque) {
    check_rotor(i);
    rotors_.number(LoadRow::joint_torque, i) += torque;
  }

  /// Prescribe the rate of joint i, which makes torques about it ineffective. Throws Error if its
  /// rate is already prescribed.
  void prescribe_joint_rate(std::size_t i, const PrescribedRate& rate) {
    check_rotor(i);
    if (rates_[i]) refuse_second_rate(i);
    rates_[i] = rate;
    any_rate_ = true;
  }

  /// Return the wrench on the frame without the rotors' reactions, about the frame's origin.
  const Wrench& on_frame() const { return frame_; }
  /// Return the wrench on the frame with the rotors' reactions, summed in the rotors' order.
  Wrench frame() const;
  /// Return the force on rotor i at its centre of mass [N].
  Vector3d rotor_force_F(std::size_t i) const { return rotors_.vector(LoadRow::force, i); }
  /// Return the torque of joint i on its rotor about the joint axis [N m].
  double joint_torque(std::size_t i) const { return rotors_.number(LoadRow::joint_torque, i); }

  /// Return whether the rate of any joint is prescribed.
  bool any_rate() const { return any_rate_; }
  /// Return the prescribed rate of joint i, or nullopt.
  const std::optional<PrescribedRate>& joint_rate(std::size_t i) const { return rates_[i]; }

  /// Return the rotors' loads for force laws on several rotors at once. Loads added here belong to
  /// no term.
  RotorRows<LoadRow::count>& rotors() { return rotors_; }
  /// Return the rotors' loads for reading.
  const RotorRows<LoadRow::count>& rotors() const { return rotors_; }

  /// Set all loads to zero. The recorded terms remain.
  void clear();
  /// Set all loads except rotors() to zero.
  void clear_rest();
  /// Return whether all loads and prescribed rates are finite.
  bool all_finite() const;
  /// Also add each load to terms[term], about the vehicle's centre of mass, until called with null.
  void record_terms(Wrench* terms, std::size_t count, const Kinematics* kinematics) {
    terms_ = terms;
    term_count_ = count;
    kinematics_ = kinematics;
  }
  /// Return the terms of the plugin that is evaluated next; null while nothing is recorded.
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
