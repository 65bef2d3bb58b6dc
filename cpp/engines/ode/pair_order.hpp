#pragma once

#include <ode/ode.h>

#include <array>
#include <vector>

namespace quadcore {

/// Axis-aligned bounding box: minimum and maximum of x, y, z [m].
using Bounds = std::array<dReal, 6>;

/// Extend a bounding box by another one.
void extend(Bounds& box, const Bounds& other);
/// Return whether two bounding boxes touch.
bool overlap(const Bounds& one, const Bounds& other);

/// An obstacle's model and a vehicle, to be examined for contacts.
struct ModelPair {
  std::size_t obstacle;  ///< index of the obstacle's model
  bool obstacle_first;   ///< whether the obstacle is the first of the two for the collider
};

/// Puts pairs of the vehicle and the models of obstacles in the order in which Gazebo 11's hash
/// space (ODE's dxHashSpace with levels from -2 to 8) finds them. The order of the contacts affects
/// the result of the sweeps.
class PairOrder {
 public:
  /// \param boxes  bounding box of each obstacle's model, the oldest first
  explicit PairOrder(std::vector<Bounds> boxes);

  /// Return the models whose boxes touch the vehicle's.
  const std::vector<ModelPair>& find(const Bounds& vehicle);

 private:
  struct Model {
    Bounds box;
    int level;
  };
  /// A pair with the place at which the hash space finds it.
  struct Found {
    std::array<int, 5> place;
    ModelPair pair;
  };

  std::vector<Model> models_;
  std::vector<Found> found_;
  std::vector<ModelPair> pairs_;
};

}  // namespace quadcore
