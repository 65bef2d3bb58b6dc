#pragma once

#include <string>

namespace quadcore::node {

/// Whether a plant is still the one that was read: it may be started later, or anew.
class PlantWatch {
 public:
  /// \param node  that flies it
  explicit PlantWatch(std::string node);

  /// Asks the master. What cannot be asked for has not changed.
  bool has_changed() const;

 private:
  std::string told() const;

  std::string node_, first_;
};

}  // namespace quadcore::node
