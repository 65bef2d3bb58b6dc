#include "quadcore/plugin/model.hpp"

#include <Eigen/Eigenvalues>

namespace quadcore {

Matrix3d Inertial::inertia_in_link_axes() const {
  const Matrix3d R = pose.rotation().toRotationMatrix();
  return R * inertia * R.transpose();
}

Vector3d Inertial::principal_moments() const {
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
}

bool Inertial::is_positive() const {
  const Vector3d principal = principal_moments();
  return principal[0] > 1e-9 * principal[2];
}

std::vector<std::string> Model::joint_names() const {
  std::vector<std::string> names;
  for (const Joint& joint : joints) names.push_back(joint.name);
  return names;
}

std::vector<Eigen::Isometry3d> link_poses(const Model& model) {
  std::vector<Eigen::Isometry3d> poses(model.links.size(), Eigen::Isometry3d::Identity());
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    poses[i + 1] =
        poses[joint.parent] * Eigen::Translation3d(joint.pose.xyz) * joint.pose.rotation();
  }
  return poses;
}

double moment_about_joint(const Model& model, std::size_t i) {
  const Vector3d& axis = model.joints[i].axis;
  const Inertial& inertial = model.links[i + 1].inertial;
  const double arm_squared = axis.cross(inertial.pose.xyz).squaredNorm();
  return axis.dot(inertial.inertia_in_link_axes() * axis) + inertial.mass * arm_squared;
}

MassProperties mass_properties(const Model& model) {
  const std::vector<Eigen::Isometry3d> poses = link_poses(model);
  MassProperties total;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Inertial& inertial = model.links[i].inertial;
    total.mass += inertial.mass;
    total.p_FCcm += inertial.mass * (poses[i] * inertial.pose.xyz);
  }
  total.p_FCcm /= total.mass;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Inertial& inertial = model.links[i].inertial;
    const Matrix3d R = poses[i].linear();
    const Matrix3d S = skew(poses[i] * inertial.pose.xyz - total.p_FCcm);
    total.inertia_Ccm_F +=
        R * inertial.inertia_in_link_axes() * R.transpose() - inertial.mass * S * S;
  }
  return total;
}

}  // namespace quadcore
