#pragma once

#include <optional>
#include <string>
#include <vector>

#include "quadcore/model.hpp"

namespace quadcore {

/// A link as the URDF writes it.
struct UrdfLink {
  std::string name;
  std::optional<Inertial> inertial;
  std::vector<Collision> collisions;
  std::string where;
};

/// A joint as the URDF writes it: continuous, or fixed.
struct UrdfJoint {
  std::string name;
  bool fixed = false;
  std::string parent;
  std::string child;
  Pose pose;
  Vector3d axis = Vector3d::UnitX();
  double damping = 0;
  std::string where;
};

/// The URDF before fixed links are lumped.
struct UrdfTree {
  std::string name;
  std::string where;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  std::vector<PluginElement> plugins;
  std::vector<std::string> warnings;
  PassedOver passed_over;
};

/// Reads the elements of a URDF, each checked by itself.
/// \param ignore  see PassedOver.
UrdfTree read_urdf_tree(const Document& document, const std::vector<std::string>& ignore);

/// Checks how links and joints hang together, lumps fixed links and checks the moving bodies.
Model lump(const UrdfTree& tree);

}  // namespace quadcore
