#pragma once

#include <ode/ode.h>

#include <array>
#include <vector>

namespace quadcore {

/// A bounding box along the world's axes: minimum and maximum of x, y, z [m].
using Bounds = std::array<dReal, 6>;

/// Extend a box so that it contains another one.
void extend(Bounds& box, const Bounds& other);
/// Return whether two boxes touch.
bool overlap(const Bounds& one, const Bounds& other);

/// A pair of models, as Gazebo passes it to its colliders.
struct ModelPair {
  std::size_t first, second;  ///< indices of the models
};

/// A model that moves.
struct MovingModel {
  Bounds box;
  double unmoved = 0;  ///< steps since it moved; infinite before its first
};

/// The order in which the hash space of Gazebo 11's ODE finds the pairs of models of which at least
/// one moves. Models that stand still have the indices from 0 on, in the order of the file; those
/// that move follow, the oldest first.
class PairOrder {
 public:
  /// \param boxes  of the models that stand still
  explicit PairOrder(const std::vector<Bounds>& boxes);

  /// Return the pairs whose boxes touch. The result is valid until the next call.
  const std::vector<ModelPair>& find(const std::vector<MovingModel>& moving);

 private:
  /// Put the indices of moving models into the order of the space, from the end of its list.
  void sort_moving(const std::vector<MovingModel>& moving);
  struct Sized {
    Bounds box;
    int level;  ///< power of 2 that its longest side does not exceed [m]
    int rank;   ///< place in the list that the space goes through
  };
  struct Found {
    std::array<int, 7> place;
    ModelPair pair;
  };
  void add(std::size_t one, std::size_t other);

  std::vector<Sized> models_;  ///< those that stand still, then those that move
  std::size_t still_;          ///< number of the former
  std::vector<int> ranked_;    ///< indices of those that move, by rank
  std::vector<Found> found_;
  std::vector<ModelPair> pairs_;
};

}  // namespace quadcore
