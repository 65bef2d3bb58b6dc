#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "quadcore/plugin/model.hpp"

namespace quadcore {

/// The bodies of an ODE engine: the links of a model on its joints. Some joints may be locked at
/// angle zero; these carry no rotor.
struct Bodies {
  Model model;
  std::vector<std::size_t> rotors;  ///< joint of each rotor, ascending

  /// Return whether no joint is locked.
  explicit Bodies(const Model& m) : model(m), rotors(m.joints.size()) {
    std::iota(rotors.begin(), rotors.end(), std::size_t{0});
  }
  Bodies(Model m, std::vector<std::size_t> r) : model(std::move(m)), rotors(std::move(r)) {}

  bool is_locked(std::size_t joint) const {
    return !std::binary_search(rotors.begin(), rotors.end(), joint);
  }
};

}  // namespace quadcore
