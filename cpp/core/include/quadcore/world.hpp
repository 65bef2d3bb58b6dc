#pragma once

#include <memory>
#include <string>

#include "quadcore/document.hpp"
#include "quadcore/export.hpp"
#include "quadcore/passed_over.hpp"
#include "quadcore/spatial.hpp"

namespace quadcore QUADCORE_EXPORT {

/// With steps below this [s] no flight would end.
constexpr double shortest_step = 1e-9;

/// What a world file sets; the defaults are Gazebo 11's.
struct World {
  Vector3d gravity_W{0, 0, -9.8};       ///< m/s^2
  double max_step_size = 0.001;         ///< s
  double real_time_update_rate = 1000;  ///< 1/s, 0 = as fast as possible; for nodes that pace
  std::string solver_type = "quick";    ///< quick | world
  std::string solver_type_where;        ///< FILE:LINE of the type
  int solver_iterations = 50;
  double solver_sor = 1.3;
  double erp = 0.2;
  double cfm = 0;
  double contact_max_correcting_vel = 100;  ///< m/s, also rad/s of hinges
  bool ground_plane = false;
  Vector3d wind_W{0, 0, 0};  ///< velocity of the air [m/s]
  PassedOver passed_over;
  /// What it was read from; null unless read_world() made it.
  std::shared_ptr<const Source> source;
};

/// Reads a world file.
/// \param ignore  names of what is to be left out, see PassedOver.
/// Throws InputError with FILE:LINE on every element that is felt and not honoured, and on
/// everything foreign that is not ignored.
World read_world(const Document& document, const std::vector<std::string>& ignore = {});

}  // namespace quadcore
