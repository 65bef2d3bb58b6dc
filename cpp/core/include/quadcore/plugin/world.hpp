#pragma once

#include <memory>
#include <string>
#include <vector>

#include "quadcore/plugin/document.hpp"
#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/passed_over.hpp"
#include "quadcore/plugin/spatial.hpp"
#include "quadcore/plugin/tags.hpp"

namespace quadcore QUADCORE_EXPORT {

/// With steps below this [s] no flight would end.
constexpr double shortest_step = 1e-9;

/// The air at z = 0; the defaults are SDF's, the standard atmosphere.
struct Atmosphere {
  double temperature = 288.15;            ///< K
  double temperature_gradient = -0.0065;  ///< K/m
  double pressure = 101325;               ///< Pa

  static constexpr double gas_constant = 287.05287;  ///< of dry air (ISO 2533) [J/(kg K)]
  /// Of dry air [kg/m^3].
  double density() const { return pressure / (gas_constant * temperature); }
};

/// Where on Earth (WGS 84) the world's origin lies; x points east there, y north.
struct Origin {
  /// Positive north [deg].
  double latitude = 0, longitude = 0;  ///< positive east [deg]
  double altitude = 0;                 ///< m
  double heading = 0;                  ///< by which the axes are turned from there [deg]
};

/// What a world file sets; the defaults are Gazebo 11's.
struct World {
  Vector3d gravity_W{0, 0, -9.8};       ///< m/s^2
  double max_step_size = 0.001;         ///< s
  double real_time_update_rate = 1000;  ///< 1/s, 0 = as fast as possible; for nodes that pace
  std::string solver_type = "quick";    ///< quick | world
  std::string solver_type_where;        ///< FILE:LINE of the type
  int solver_iterations = 50;           ///< of solver quick in a step
  double solver_sor = 1.3;              ///< over-relaxation of solver quick
  double erp = 0.2;                     ///< share of a hinge's error that a step corrects
  double cfm = 0;                       ///< ODE's constraint force mixing, by which hinges give way
  double contact_max_correcting_vel = 100;  ///< m/s, also rad/s of hinges
  bool ground_plane = false;                ///< whether there is ground at z = 0
  Vector3d wind_W{0, 0, 0};                 ///< velocity of the air [m/s]
  Atmosphere atmosphere;                    ///< of the air at z = 0
  Vector3d magnetic_field_W{5.5645e-6, 22.8758e-6, -42.3884e-6};  ///< x east, y north, z up [T]
  Origin origin;                                                  ///< of its axes, on Earth
  PassedOver passed_over;  ///< what its reader did not take in
  /// What it was read from; null unless read_world() made it.
  std::shared_ptr<const Source> source;
};

/// Reads a world file.
/// \param ignore  names of what is to be left out, see PassedOver.
/// Throws InputError with FILE:LINE on every element that is felt and not honoured, and on
/// everything foreign that is not ignored.
World read_world(const Document& document, const std::vector<std::string>& ignore = {});

/// The elements that read_world() takes, named by their paths below `<world>`. Parsing, errors and
/// the docs come from here.
std::vector<TagSpec> world_elements();

}  // namespace quadcore
