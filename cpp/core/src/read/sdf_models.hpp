#pragma once

#include <string>
#include <vector>

#include "quadcore/plugin/free_body.hpp"
#include "quadcore/plugin/obstacle.hpp"
#include "sdf_pose.hpp"
#include "xml.hpp"

namespace quadcore {

/// The models of a world.
struct WorldModels {
  std::vector<Obstacle> obstacles;     ///< in the order of the file
  std::vector<FreeBody> free_bodies;   ///< likewise
  std::vector<FreeJoint> free_joints;  ///< likewise
  std::vector<std::string> ignored;    ///< models that the user ignores, or URIs
  double start_time = 0;               ///< time at which a saved world starts [s]
};

/// Read the models and included models of a world as Gazebo 11 does. Models that nothing feels are
/// recorded as harmless. Throws InputError with FILE:LINE and a proposal to ignore the model for
/// one that the vehicle could feel but that is not supported.
WorldModels read_models(const Xml& xml, const Xml::Element& world);

/// Skip a Gazebo plugin. One that does more than sense or publish is recorded as not simulated.
/// Throws InputError for one that moves the air, unless the user ignores it.
/// \param model  name of its model, or ""
void skip_plugin(const Xml& xml, const Xml::Element& plugin, const std::string& model);

}  // namespace quadcore
