#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "quadcore/export.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Who writes a topic: the index of a plugin among Simulation::plugins(), or one of these.
constexpr int nobody = -2;
constexpr int the_caller = -1;  ///< of Simulation::command()

/// A named message inside the simulation: a fixed row of numbers. Values belong to the simulation,
/// so snapshots hold them. The ROS node carries `vel_cmd` and `odom`, no others.
struct Topic {
  std::string name;
  std::vector<std::string> fields;
  std::vector<double> values;
  double stamp = 0;  ///< time of the last message [s]
  double count = 0;  ///< messages so far; 0 = none yet
  int writer = nobody;
};

/// What a topic holds at one moment, as snapshots keep it.
struct Message {
  std::vector<double> values;
  double stamp;
  double count;
  int writer;
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
  /// Throws InputError if the topic has another writer already.
  void publish(std::size_t index, double time) {
    Topic& topic = topics_[index];
    if (topic.writer != writer_) claim(topic);
    topic.stamp = time;
    topic.count += 1;
  }
  std::size_t size() const { return topics_.size(); }

  /// What each topic holds.
  std::vector<Message> messages() const;
  /// Throws InputError unless these are the messages of topics like these.
  void check(const std::vector<Message>& messages) const;
  /// Puts messages() back, which have been checked.
  void restore(const std::vector<Message>& messages);

  /// Names the next plugin for errors: "FILE:LINE: plugin 'name'". The simulation's to call.
  void add_writer(const std::string& who) { writers_.push_back(who); }
  /// Whose publish() calls follow. The simulation's to call.
  void write_as(int writer) { writer_ = writer; }
  /// How errors call a writer.
  std::string name_of(int writer) const;

 private:
  void claim(Topic& topic) const;

  std::vector<Topic> topics_;
  std::vector<std::string> writers_;
  int writer_ = the_caller;
};

}  // namespace quadcore
