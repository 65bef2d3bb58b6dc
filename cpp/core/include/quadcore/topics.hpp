#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace quadcore {

/// A named message inside the simulation: a fixed row of numbers. Values belong to the simulation,
/// so snapshots hold them; a ROS node carries them to topics of the same name.
struct Topic {
  std::string name;
  std::vector<std::string> fields;
  std::vector<double> values;
  double stamp = 0;  ///< time of the last message [s]
  double count = 0;  ///< messages so far; 0 = none yet
};

/// The topics of one simulation.
class Topics {
 public:
  /// Declares a topic, or joins one that is declared already with as many fields.
  /// Returns its index. Throws InputError if the widths differ.
  std::size_t declare(const std::string& name, const std::vector<std::string>& fields);
  /// Index of a declared topic, or -1.
  int find(const std::string& name) const;

  const Topic& operator[](std::size_t index) const { return topics_[index]; }
  /// Where a publisher writes its values; publish() afterwards.
  std::vector<double>& values(std::size_t index) { return topics_[index].values; }
  void publish(std::size_t index, double time) {
    topics_[index].stamp = time;
    topics_[index].count += 1;
  }
  std::size_t size() const { return topics_.size(); }

 private:
  std::vector<Topic> topics_;
};

}  // namespace quadcore
