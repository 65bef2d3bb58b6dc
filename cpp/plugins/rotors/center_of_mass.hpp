#pragma once

#include <set>
#include <string>

#include "quadcore/plugin/model.hpp"
#include "quadcore/urdf_tree.hpp"

namespace quadcore::rotors {

/// Return the centre of mass of a link of the frame including the links fixed to it, in the link's
/// frame [m]. Links on locked joints are separate in Gazebo and therefore in RotorS.
inline Vector3d center_of_mass(const Model& model, const std::string& link) {
  if (!model.urdf) return Vector3d::Zero();
  std::set<std::string> parts = {link};
  for (std::size_t before = 0; before != parts.size();) {
    before = parts.size();
    for (const UrdfJoint& joint : model.urdf->joints) {
      if (joint.fixed && !joint.locked && parts.count(joint.parent)) parts.insert(joint.child);
    }
  }
  double mass = 0;
  Vector3d moment_F = Vector3d::Zero();
  for (const UrdfLink& part : model.urdf->links) {
    if (!parts.count(part.name) || !part.inertial) continue;
    mass += part.inertial->mass;
    const Pose X_FP = model.pose_of_link.at(part.name);
    moment_F += part.inertial->mass * (X_FP * part.inertial->pose).xyz;
  }
  if (!(mass > 0)) return Vector3d::Zero();
  const Pose X_FS = model.pose_of_link.at(link);
  return X_FS.rotation().conjugate() * (moment_F / mass - X_FS.xyz);
}

}  // namespace quadcore::rotors
