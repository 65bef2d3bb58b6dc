#pragma once

#include <mutex>
#include <vector>

#include "flight_thread.hpp"
#include "reconfigure.hpp"

namespace quadcore::node {

/// The mean wind of the model's libwind_plugin.so, or of the world, as values that may change
/// during a flight.
class MeanWind {
 public:
  /// If the model has no wind plugin, returns one for the world's wind, and removes it from the
  /// world. The flight stays bit-identical.
  static std::vector<PluginElement> replace_wind(World& world, const Model& model);

  explicit MeanWind(const Simulation& simulation);
  /// Reads the present wind. Call after each step, in the flight's thread.
  void note(const Simulation& simulation);
  /// Returns wind_x, wind_y and wind_z.
  std::vector<Adjustable> adjustables(FlightThread& flight);

 private:
  const Topic& topic_in(const Simulation& simulation) const;
  Vector3d read(const Simulation& simulation) const;
  double get(int axis) const;
  void set(FlightThread& flight, int axis, double speed);

  int topic_ = -1;                         ///< index of the topic that sets the wind; -1 = no wind
  Vector3d initial_W_ = Vector3d::Zero();  ///< until the first message [m/s]
  mutable std::mutex mutex_;
  Vector3d now_W_ = Vector3d::Zero();  ///< m/s
};

}  // namespace quadcore::node
