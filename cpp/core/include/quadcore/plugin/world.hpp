#pragma once

#include <memory>
#include <string>
#include <vector>

#include "quadcore/plugin/document.hpp"
#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/free_body.hpp"
#include "quadcore/plugin/ignored_elements.hpp"
#include "quadcore/plugin/obstacle.hpp"
#include "quadcore/plugin/spatial.hpp"
#include "quadcore/plugin/tags.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Minimum time step [s].
constexpr double shortest_step = 1e-9;

/// The air at z = 0; the defaults are SDF's, the standard atmosphere.
struct Atmosphere {
  double temperature = 288.15;            ///< K
  double temperature_gradient = -0.0065;  ///< K/m
  double pressure = 101325;               ///< Pa

  static constexpr double gas_constant =
      287.05287;  ///< specific gas constant of dry air (ISO 2533) [J/(kg K)]
  /// Return the density of dry air [kg/m^3].
  double density() const { return pressure / (gas_constant * temperature); }
};

/// Position of the world's origin on Earth (WGS 84); x points east, y north.
struct Origin {
  /// Positive north [deg].
  double latitude = 0, longitude = 0;  ///< positive east [deg]
  double altitude = 0;                 ///< m
  double heading = 0;                  ///< rotation of the axes from east and north [deg]
};

/// Settings of a world file; the defaults are Gazebo 11's.
struct World {
  Vector3d gravity_W{0, 0, -9.8};       ///< m/s^2
  double max_step_size = 0.001;         ///< s
  double real_time_update_rate = 1000;  ///< 1/s, 0 = as fast as possible; for nodes in real time
  std::string solver_type = "quick";    ///< quick | world
  std::string solver_type_where;        ///< FILE:LINE of the solver type
  int solver_iterations = 50;           ///< iterations of solver quick per step
  double solver_sor = 1.3;              ///< over-relaxation of solver quick
  double erp = 0.2;                     ///< fraction of a hinge's error that a step corrects
  double cfm = 0;                       ///< ODE's constraint force mixing, the compliance of hinges
  double contact_max_correcting_vel = 100;  ///< m/s; also rad/s for hinges
  bool ground_plane = false;                ///< whether there is ground at z = 0
  /// Contact parameters of that ground; the default is that of `model://ground_plane`.
  Surface ground = {100, 50};
  int max_contacts = 20;            ///< maximum number of points at which a pair of shapes touches
  std::vector<Obstacle> obstacles;  ///< all others that stand still, in the order of the file
  std::vector<FreeBody> free_bodies;   ///< those that move, in the order of the file
  std::vector<FreeJoint> free_joints;  ///< joints of the free bodies
  Vector3d wind_W{0, 0, 0};            ///< velocity of the air [m/s]
  Atmosphere atmosphere;               ///< air at z = 0
  Vector3d magnetic_field_W{5.5645e-6, 22.8758e-6, -42.3884e-6};  ///< x east, y north, z up [T]
  Origin origin;                                                  ///< position on Earth
  double start_time = 0;                    ///< time at which a saved world starts [s]
  IgnoredElements ignored_elements;         ///< elements that the reader did not use
  std::vector<std::string> ignored_models;  ///< ignored on request, though they may be obstacles
  /// Source of the world; null unless read_world() created it.
  std::shared_ptr<const Source> source;
};

/// Read a world file.
/// \param ignore  names of elements to ignore, see IgnoredElements.
/// Throws InputError with FILE:LINE for elements that affect the motion but are not modelled, and
/// for unknown elements that are not ignored.
World read_world(const Document& document, const std::vector<std::string>& ignore = {});

/// Return the elements that read_world() supports, named by their paths below `<world>`. They are
/// used for parsing, errors and the docs.
std::vector<TagSpec> world_elements();

}  // namespace quadcore
