#pragma once

#include <vector>

#include "bodies.hpp"
#include "hinged_tree.hpp"
#include "quadcore/plugin/world.hpp"

namespace quadcore {

/// What a HingedTree takes of bodies.
struct HingedModel {
  std::vector<std::size_t> carriers;
  std::vector<char> carries, brakes, locks;

  explicit HingedModel(const Bodies& bodies);
  HingedTree tree(const World& world, double max_correction) const;
  /// Whether all hinges are on the frame, and none brakes or is locked.
  bool is_star() const;
};

/// Rows of BodyConstant of a body of a model.
std::vector<double> body_constants(const Model& model, std::size_t body);

}  // namespace quadcore
