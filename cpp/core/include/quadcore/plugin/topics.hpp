#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/messages.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Who writes a topic: the index of a plugin among Simulation::plugins(), or this one, where none
/// does.
constexpr int the_caller = -1;  ///< of Simulation::publish()

/// What a topic holds at one moment, as snapshots keep it.
struct Message {
  std::vector<double>
      values;        ///< in the order of MessageKind::fields, at first MessageKind::unsaid
  double stamp = 0;  ///< time of the last message [s]
  double count = 0;  ///< messages so far; 0 = none yet
};

/// A named message inside the simulation: a row of numbers of one kind.
struct Topic : Message {
  std::string name;               ///< a word, for logs and Python
  std::string path;               ///< the same where names may have parts, / between them
  MessageKind kind;               ///< what its numbers mean
  int writer = the_caller;        ///< index of a plugin, or the_caller
  std::vector<int> readers = {};  ///< plugins
};

/// The topics of one simulation. A plugin declares in its constructor what it publishes and what it
/// takes; the simulation checks that the declarations agree once all plugins are made.
class Topics {
 public:
  /// \name For the constructors of plugins
  /// All return the topic's index. A name may have parts, "motor_speed/0", which bridges that know
  /// such names keep; elsewhere it is motor_speed_0. Throw InputError on a name or a field that is
  /// no plain word then.
  /// @{

  /// Declares that the plugin writes the topic, which nobody else may then.
  std::size_t publishes(const std::string& name, const MessageKind& kind);
  /// The same of a topic that has as many fields as who takes it asks for, or else those of `kind`.
  std::size_t publishes_as_taken(const std::string& name, const MessageKind& kind);
  /// Declares that the plugin reads the topic. It runs after the plugin that writes it, and so has
  /// the value of the same sample; or, `late`, whenever that runs, the value from before this
  /// sample began.
  std::size_t takes(const std::string& name, const MessageKind& kind, bool late = false);
  /// @}

  /// \name For hooks
  /// @{

  /// A topic, by the index that its declaration returned.
  const Topic& operator[](std::size_t index) const { return topics_[index]; }
  /// The last message.
  template <class M>
  M read(std::size_t index) const {
    return messages::read<M>(topics_[index].values.data());
  }
  /// Publishes a message, whose numbers are to be written at once where this points.
  /// Throws InputError if the topic is not the writer's.
  double* publish(std::size_t index, double time) {
    Topic& topic = topics_[index];
    if (topic.writer != writer_) refuse_writer(topic);
    topic.stamp = time;
    topic.count += 1;
    return topic.values.data();
  }
  /// Publishes a message. Throws InputError if the topic is not the writer's.
  template <class M>
  void publish(std::size_t index, double time, const M& message) {
    messages::write(message, publish(index, time));
  }
  /// @}

  /// How errors call a writer.
  std::string name_of(int writer) const;
  /// Throws InputError: `who` is a second writer.
  [[noreturn]] void refuse_second(const std::string& who, const Topic& topic) const;
  /// Index of a declared topic, by name or path, or -1.
  int find(const std::string& name) const;
  /// Index of a declared topic. Throws InputError with the names of those there are.
  std::size_t at(const std::string& name) const;
  /// The same of several; they must differ.
  std::vector<std::size_t> at(const std::vector<std::string>& names) const;
  /// Of every declared topic, in the order of declaration.
  std::vector<std::string> names() const;

  /// \name For the simulation
  /// @{

  /// Whose declarations follow: a plugin as errors call it, "FILE:LINE: plugin 'name'".
  void add_plugin(const std::string& name, const std::string& who);
  /// Checks that all declarations agree and returns the order in which plugins run: writers before
  /// readers, otherwise by name. Throws InputError naming the plugins at fault.
  std::vector<std::size_t> settle();
  /// Whose publish() calls follow.
  void write_as(int writer) { writer_ = writer; }
  /// A round of hooks begins: late readers see what is there now.
  void begin_sample() {
    for (const auto& [copy, original] : late_) {
      static_cast<Message&>(topics_[copy]) = topics_[original];
    }
  }
  /// What each topic holds, and each late reader has of it.
  std::vector<Message> messages() const;
  /// Throws InputError unless these are the messages of topics like these.
  void check(const std::vector<Message>& messages) const;
  /// Puts messages() back, which have been checked.
  void restore(const std::vector<Message>& messages);
  /// @}

 private:
  struct Participant {
    std::string name, who;
  };
  struct Declaration {
    int plugin;
    std::size_t topic;
    MessageKind kind;
    bool writes, late;
    bool open = false;  ///< the takers say which fields it has
  };
  struct LateCopy {
    std::size_t copy, original;
  };

  std::size_t declare(const std::string& path, const MessageKind& kind, bool writes, bool late);
  std::size_t add(const std::string& path, const MessageKind& kind);
  bool is_copy(std::size_t index) const;
  [[noreturn]] void refuse_writer(const Topic& topic) const;
  [[noreturn]] void refuse_loop(const std::vector<bool>& placed) const;
  void close(Declaration& open);
  void hold_what_is_unsaid();
  const Declaration& authority(std::size_t topic) const;
  std::vector<std::size_t> order() const;
  const Declaration* awaited(std::size_t plugin, const std::vector<bool>& placed) const;

  std::vector<Topic> topics_;
  std::vector<LateCopy> late_;
  std::vector<Participant> plugins_;
  std::vector<Declaration> declarations_;
  int writer_ = the_caller;
};

}  // namespace quadcore
