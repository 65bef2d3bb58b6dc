#include "quadcore/plugin/topics.hpp"

#include <algorithm>
#include <cctype>

#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

/// Reject names that cannot be columns of logs, variables in MATLAB and topics in ROS.
void check_word(const std::string& what, const std::string& name) {
  const auto is_plain = [](unsigned char c) { return c < 0x80 && (std::isalnum(c) || c == '_'); };
  if (!name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) &&
      std::all_of(name.begin(), name.end(), is_plain)) {
    return;
  }
  throw InputError(
      what + " '" + name +
      "' is not a valid name. Start with a letter and use only letters, digits and _.");
}

/// Return the topic name of a path, with / replaced by _. Invalid paths such as "a//b" give invalid
/// names.
std::string word_of(const std::string& path) {
  std::string word = path;
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    if (path[i] == '/' && path[i - 1] != '/') word[i] = '_';
  }
  return word;
}

}  // namespace

std::size_t Topics::publishes(const std::string& name, const MessageKind& kind) {
  return declare(name, kind, true, false);
}

std::size_t Topics::publishes_as_taken(const std::string& name, const MessageKind& kind) {
  const std::size_t index = declare(name, kind, true, false);
  declarations_.back().open = true;
  return index;
}

std::size_t Topics::takes(const std::string& name, const MessageKind& kind, bool late) {
  const std::size_t original = declare(name, kind, false, late);
  if (!late) return original;
  for (const LateCopy& known : late_) {
    if (known.original == original) return known.copy;
  }
  late_.push_back({add(name, kind), original});
  return late_.back().copy;
}

std::size_t Topics::declare(const std::string& path, const MessageKind& kind, bool writes,
                            bool late) {
  const std::string name = word_of(path);
  check_word("topic", name);
  for (const std::string& field : kind.fields) check_word("topic '" + name + "': field", field);
  const int known = find(name);
  const std::size_t index = known < 0 ? add(path, kind) : static_cast<std::size_t>(known);
  if (path != name) topics_[index].path = path;
  declarations_.push_back({static_cast<int>(plugins_.size()) - 1, index, kind, writes, late});
  return index;
}

std::size_t Topics::add(const std::string& path, const MessageKind& kind) {
  Topic topic;
  topic.name = word_of(path);
  topic.path = path;
  topic.kind = kind;
  topic.values.assign(kind.fields.size(), 0.0);
  topics_.push_back(topic);
  return topics_.size() - 1;
}

bool Topics::is_copy(std::size_t index) const {
  return std::any_of(late_.begin(), late_.end(),
                     [index](const LateCopy& late) { return late.copy == index; });
}

int Topics::find(const std::string& name) const {
  const std::string word = word_of(name);
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    if (topics_[i].name == word && !is_copy(i)) return static_cast<int>(i);
  }
  return -1;
}

std::size_t Topics::at(const std::string& name) const {
  const int index = find(name);
  if (index >= 0) return static_cast<std::size_t>(index);
  const std::vector<std::string> known = names();
  throw InputError(
      "topic '" + name + "' does not exist." + suggest(name, known) +
      (known.empty() ? " No plugin declares a topic." : " Choose one of " + joined(known) + "."));
}

std::vector<std::size_t> Topics::at(const std::vector<std::string>& names) const {
  std::vector<std::size_t> indices;
  for (const std::string& name : names) {
    const std::size_t index = at(name);
    if (std::find(indices.begin(), indices.end(), index) != indices.end()) {
      throw InputError("topic '" + name + "' is named twice. Name it once.");
    }
    indices.push_back(index);
  }
  return indices;
}

std::vector<std::string> Topics::names() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    if (!is_copy(i)) names.push_back(topics_[i].name);
  }
  return names;
}

std::string Topics::name_of(int writer) const {
  return writer == the_caller ? "the caller" : plugins_[static_cast<std::size_t>(writer)].who;
}

void Topics::refuse_writer(const Topic& topic) const {
  if (topic.writer == the_caller) {
    throw InputError(name_of(writer_) + " writes topic '" + topic.name +
                     "', which it did not declare. Call topics.publishes() in its constructor.");
  }
  refuse_second(name_of(writer_), topic);
}

void Topics::refuse_second(const std::string& who, const Topic& topic) const {
  throw InputError(who + " writes topic '" + topic.name + "', which " + name_of(topic.writer) +
                   " already writes. Keep one of the two.");
}

void Topics::note_updates(const std::vector<bool>& updating_plugins) {
  for (Topic& topic : topics_) {
    const auto note = [&](int plugin) {
      const auto index = static_cast<std::size_t>(plugin);
      if (updating_plugins[index]) topic.concerned |= set_of(index);
    };
    for (const int reader : topic.readers) note(reader);
    if (topic.writer != the_caller) note(topic.writer);
  }
}

std::vector<Message> Topics::messages() const { return {topics_.begin(), topics_.end()}; }

void Topics::check(const std::vector<Message>& messages) const {
  const auto fits = [](const Message& message, const Topic& topic) {
    return message.values.size() == topic.values.size();
  };
  if (!std::equal(messages.begin(), messages.end(), topics_.begin(), topics_.end(), fits)) {
    throw InputError("snapshot: its messages belong to other topics. Take a new snapshot.");
  }
}

void Topics::restore(const std::vector<Message>& messages) {
  news_ = UINT64_MAX;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    Topic& topic = topics_[i];
    static_cast<Message&>(topic) = messages[i];
    // Before the first message, the values that this simulation's plugins assume apply; their tags
    // may differ from those of the snapshot.
    if (topic.count == 0 && !topic.kind.unsaid.empty()) topic.values = topic.kind.unsaid;
  }
}

}  // namespace quadcore
