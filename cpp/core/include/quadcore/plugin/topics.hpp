#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "quadcore/plugin/export.hpp"
#include "quadcore/plugin/messages.hpp"

namespace quadcore QUADCORE_EXPORT {

/// Writer of a topic that no plugin writes; otherwise an index into Simulation::plugins().
constexpr int the_caller = -1;  ///< the caller of Simulation::publish()

/// Content of a topic at one instant, as stored in snapshots.
struct Message {
  std::vector<double>
      values;        ///< in the order of MessageKind::fields; initially MessageKind::unsaid
  double stamp = 0;  ///< time of the last message [s]
  double count = 0;  ///< number of messages so far
};

/// A named channel inside the simulation with messages of one kind.
struct Topic : Message {
  std::string name;               ///< name without separators, for logs and Python
  std::string path;               ///< name with / as a separator
  MessageKind kind;               ///< meaning of its values
  int writer = the_caller;        ///< index of a plugin, or the_caller
  std::vector<int> readers = {};  ///< indices of plugins
  std::uint64_t concerned = 0;    ///< set of the plugins with an update() that may read or write it
};

/// The topics of one simulation. A plugin declares in its constructor which topics it publishes and
/// reads. The simulation checks the declarations once all plugins have been created.
class Topics {
 public:
  /// \name For the constructors of plugins
  /// All return the topic's index. A name such as "motor_speed/0" keeps its separators in bridges
  /// that support them; elsewhere it is motor_speed_0. They throw InputError for an invalid name or
  /// field.
  /// @{

  /// Declare that the plugin writes the topic exclusively.
  std::size_t publishes(const std::string& name, const MessageKind& kind);
  /// Declare that the plugin writes a topic with the fields that its reader expects, else those of
  /// `kind`.
  std::size_t publishes_as_taken(const std::string& name, const MessageKind& kind);
  /// Declare that the plugin reads the topic. It runs after the writer and reads the value of the
  /// same sample; with `late`, it reads the value from before this sample, independent of the
  /// order.
  std::size_t takes(const std::string& name, const MessageKind& kind, bool late = false);
  /// @}

  /// \name For hooks
  /// @{

  /// Return a topic by the index that its declaration returned.
  const Topic& operator[](std::size_t index) const { return topics_[index]; }
  /// Return the last message.
  template <class M>
  M read(std::size_t index) const {
    return messages::read<M>(topics_[index].values.data());
  }
  /// Publish a message. The caller must write its values at once to the returned pointer. Throws
  /// InputError if another writer owns the topic.
  double* publish(std::size_t index, double time) {
    Topic& topic = topics_[index];
    if (topic.writer != writer_) refuse_writer(topic);
    topic.stamp = time;
    topic.count += 1;
    news_ |= topic.concerned;
    return topic.values.data();
  }
  /// Publish a message. Throws InputError if another writer owns the topic.
  template <class M>
  void publish(std::size_t index, double time, const M& message) {
    messages::write(message, publish(index, time));
  }
  /// @}

  /// Return the name of a writer for error messages.
  std::string name_of(int writer) const;
  /// Throw InputError because `who` is a second writer.
  [[noreturn]] void refuse_second(const std::string& who, const Topic& topic) const;
  /// Return the index of a topic by name or path, or -1.
  int find(const std::string& name) const;
  /// Return the index of a topic. Throws InputError with the names of all topics.
  std::size_t at(const std::string& name) const;
  /// Return the indices of several different topics.
  std::vector<std::size_t> at(const std::vector<std::string>& names) const;
  /// Return the names of all topics in the order of declaration.
  std::vector<std::string> names() const;

  /// \name For the simulation
  /// @{

  /// Set the plugin that declares topics next; `who` is "FILE:LINE: plugin 'name'" for errors.
  void add_plugin(const std::string& name, const std::string& who);
  /// Check that all declarations agree and return the order in which plugins run: writers before
  /// readers, otherwise by name. Throws InputError that names the conflicting plugins.
  std::vector<std::size_t> settle();
  /// Set the writer of the following publish() calls.
  void write_as(int writer) { writer_ = writer; }
  /// Note which plugins have an update(), which may read and write their topics.
  void note_updates(const std::vector<bool>& updating_plugins);
  /// Return the set of these plugins with a topic that has changed since the last take_news().
  std::uint64_t news() const { return news_; }
  /// Return the same set and empty it.
  std::uint64_t take_news() { return std::exchange(news_, 0); }
  /// Return the set of one plugin. Plugins 64 places apart count as the same one.
  static std::uint64_t set_of(std::size_t plugin) { return std::uint64_t{1} << plugin % 64; }
  /// Begin a sample: late readers see the values of this moment.
  void begin_sample() {
    for (const auto& [copy, original] : late_) {
      static_cast<Message&>(topics_[copy]) = topics_[original];
    }
  }
  /// Return the content of all topics and of the copies for late readers.
  std::vector<Message> messages() const;
  /// Throw InputError unless the messages fit these topics.
  void check(const std::vector<Message>& messages) const;
  /// Restore checked messages().
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
    bool open = false;  ///< the readers define the fields
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
  const Declaration& find_authority(std::size_t topic) const;
  std::vector<std::size_t> order() const;
  const Declaration* awaited(std::size_t plugin, const std::vector<bool>& placed) const;

  std::vector<Topic> topics_;
  std::vector<LateCopy> late_;
  std::vector<Participant> plugins_;
  std::vector<Declaration> declarations_;
  int writer_ = the_caller;
  std::uint64_t news_ = UINT64_MAX;  ///< set of plugins
};

}  // namespace quadcore
