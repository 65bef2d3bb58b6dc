#pragma once

#include <vector>

#include "bodies.hpp"
#include "hinged_tree.hpp"
#include "quadcore/plugin/world.hpp"

namespace quadcore {

/// Data of bodies for a HingedTree.
struct HingedModel {
  std::vector<std::size_t> carriers;
  std::vector<char> carries, brakes, locks;

  explicit HingedModel(const Bodies& bodies);
  HingedTree tree(const World& world, double max_correction) const;
  /// Return whether all hinges are on the frame without implicit damping or locks.
  bool is_star() const;
};

/// Return the rows of BodyConstant of a model's body.
std::vector<double> body_constants(const Model& model, std::size_t body);

}  // namespace quadcore
