#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sdf_pose.hpp"
#include "xml.hpp"

namespace quadcore {

/// What the `<state>` of a saved world contains about a link.
struct SavedLink {
  std::optional<Placement> pose_W;
  Vector3d linear_velocity_W = Vector3d::Zero();   ///< m/s
  Vector3d angular_velocity_W = Vector3d::Zero();  ///< rad/s
};

/// What the `<state>` of a saved world contains about a model. It overrides the model.
struct SavedModel {
  std::optional<Placement> pose_W;         ///< pose of the model
  Vector3d scale = Vector3d::Ones();       ///< of its shapes
  std::map<std::string, SavedLink> links;  ///< by name
  std::map<std::string, SavedModel> models;
};

/// The `<state>` of a saved world.
struct SavedState {
  double time = 0;                            ///< s
  std::map<std::string, SavedModel> models;   ///< by name
  std::vector<const Xml::Element*> inserted;  ///< the `<insertions>` elements
  std::set<std::string> deleted;              ///< names of models
};

/// Read the first `<state>` of a world; without one, the result is empty.
SavedState read_saved_state(const Xml& xml, const Xml::Element& world);

}  // namespace quadcore
