#pragma once

#include <string>

namespace quadcore::node {

/// Detects changes of a plant's parameters, for example after a restart.
class PlantWatch {
 public:
  /// \param node  node of the plant
  explicit PlantWatch(std::string node);

  /// Asks the master. Without an answer, the plant counts as unchanged.
  bool has_changed() const;

 private:
  std::string read_parameters() const;

  std::string node_, first_;
};

}  // namespace quadcore::node
