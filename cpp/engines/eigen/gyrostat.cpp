#include "gyrostat.hpp"

#include <algorithm>
#include <limits>

#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

constexpr double position_tolerance = 1e-9;  // m
constexpr double inertia_tolerance = 1e-6;   // relative

[[noreturn]] void refuse(const Joint& joint, const std::string& why) {
  throw InputError(joint.where + ": joint '" + joint.name + "': " + why +
                   ", which the engine eigen cannot represent. Use the engine ode.");
}

/// Return the mean of an inertia over rotations about an axis, if that is a principal axis.
Matrix3d averaged(const Matrix3d& I, const Vector3d& axis) {
  const double axial = axis.dot(I * axis), transverse = (I.trace() - axial) / 2;
  return transverse * Matrix3d::Identity() + (axial - transverse) * axis * axis.transpose();
}

bool are_close(const Matrix3d& a, const Matrix3d& b) {
  return (a - b).norm() <= inertia_tolerance * a.norm();
}

void check(const Model& model, std::size_t i) {
  const Joint& joint = model.joints[i];
  const Link& link = model.links[i + 1];
  if (joint.parent != 0) {
    refuse(joint, "its parent is the moving link '" + model.links[joint.parent].name + "'");
  }
  if (joint.axis.cross(link.inertial.pose.xyz).norm() > position_tolerance) {
    refuse(joint, "the centre of mass of '" + link.name + "' lies off the axis");
  }
  const Matrix3d I = link.inertial.inertia_in_link_axes();
  if (!are_close(I, averaged(I, joint.axis))) {
    refuse(joint, "the inertia of '" + link.name + "' is not symmetric about the axis");
  }
}

bool is_along_z(const Vector3d& v) { return v.x() == 0 && v.y() == 0; }

}  // namespace

Matrix3d Gyrostat::inverse_inertia_with(const std::vector<bool>& rotors_of_frame) const {
  Matrix3d reduced = I_Ccm_F;
  for (std::size_t i = 0; i < rotors_of_frame.size(); ++i) {
    if (rotors_of_frame[i]) continue;
    const Vector3d axis_F = rotors.vector(RotorConstant::axis_F, i);
    reduced -= rotors.number(RotorConstant::moment, i) * axis_F * axis_F.transpose();
  }
  return reduced.inverse();
}

Gyrostat::Gyrostat(const Model& model) : rotors(model.joints.size()) {
  const MassProperties total = mass_properties(model);
  inverse_mass = 1 / total.mass;
  p_FCcm_F = total.p_FCcm;
  I_Ccm_F = total.inertia_Ccm_F;
  Matrix3d reduced = I_Ccm_F;
  const std::vector<Eigen::Isometry3d> poses = link_poses(model);
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    check(model, i);
    const Joint& joint = model.joints[i];
    const Inertial& inertial = model.links[i + 1].inertial;
    p_FRcm_F.push_back(poses[i + 1] * inertial.pose.xyz);
    R_FR_at_zero.push_back(poses[i + 1].linear());
    const Vector3d axis_F = R_FR_at_zero.back() * joint.axis;
    const double moment = moment_about_joint(model, i);
    rotors.set_vector(RotorConstant::axis_F, i, axis_F);
    rotors.set_vector(RotorConstant::p_CR_F, i, poses[i + 1].translation() - p_FCcm_F);
    rotors.set_vector(RotorConstant::p_CRcm_F, i, p_FRcm_F.back() - p_FCcm_F);
    rotors.number(RotorConstant::moment, i) = moment;
    rotors.number(RotorConstant::inverse_moment, i) = 1 / moment;
    rotors.number(RotorConstant::damping, i) = joint.damping;
    reduced -= moment * axis_F * axis_F.transpose();
    const Matrix3d& R_FR = R_FR_at_zero.back();
    normals_turn |= !joint.axis.cross(Vector3d::UnitZ()).isZero(0);
    upright &= is_along_z(axis_F) && is_along_z(R_FR.col(2)) && is_along_z(R_FR.row(2));
  }
  inverse_reduced_I_F = reduced.inverse();
}

double find_reach(const Model& model, const Gyrostat& body) {
  double reach = -std::numeric_limits<double>::infinity();
  const std::vector<Eigen::Isometry3d> poses = link_poses(model);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const double arm = (poses[i].translation() - body.p_FCcm_F).norm();
    for (const Collision& collision : model.links[i].collisions) {
      reach = std::max(
          reach, arm + collision.pose.xyz.norm() + outer_radius(collision.kind, collision.size));
    }
  }
  return reach;
}

Model with_round_rotors(const Model& model, std::vector<std::string>& warnings) {
  Model round = model;
  std::vector<std::string> links;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Vector3d& axis = model.joints[i].axis;
    Inertial& inertial = round.links[i + 1].inertial;
    const Matrix3d I = inertial.inertia_in_link_axes(), mean = averaged(I, axis);
    const double axial = axis.dot(I * axis);
    const bool is_principal = (I * axis - axial * axis).norm() <= inertia_tolerance * I.norm();
    if (are_close(I, mean) || !is_principal) continue;
    inertial.pose.rpy.setZero();
    inertial.inertia = mean;
    links.push_back(round.links[i + 1].name);
  }
  if (!links.empty()) {
    warnings.push_back(
        model.links[model.body_of_link.at(links.front())].where +
        ": the engine eigen averages the inertia of " + joined(links) +
        " over a turn about the joint. Use the engine ode to simulate it as written.");
  }
  return round;
}

}  // namespace quadcore
