#include "quadcore/topics.hpp"

#include "quadcore/error.hpp"

namespace quadcore {

std::size_t Topics::declare(const std::string& name, const std::vector<std::string>& fields) {
  const int known = find(name);
  if (known < 0) {
    topics_.push_back({name, fields, std::vector<double>(fields.size(), 0.0)});
    return topics_.size() - 1;
  }
  const auto index = static_cast<std::size_t>(known);
  if (topics_[index].fields.size() != fields.size()) {
    throw InputError("topic '" + name + "' has " + std::to_string(topics_[index].fields.size()) +
                     " fields in one plugin and " + std::to_string(fields.size()) +
                     " in another; make them agree");
  }
  return index;
}

int Topics::find(const std::string& name) const {
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    if (topics_[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

std::vector<Message> Topics::messages() const {
  std::vector<Message> messages;
  for (const Topic& t : topics_) messages.push_back({t.values, t.stamp, t.count, t.writer});
  return messages;
}

void Topics::check(const std::vector<Message>& messages) const {
  bool fits = messages.size() == topics_.size();
  for (std::size_t i = 0; fits && i < topics_.size(); ++i) {
    fits = messages[i].values.size() == topics_[i].values.size() && messages[i].writer >= nobody &&
           messages[i].writer < static_cast<int>(writers_.size());
  }
  if (!fits) throw InputError("snapshot: its messages are of other topics; take it anew");
}

void Topics::restore(const std::vector<Message>& messages) {
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    topics_[i].values = messages[i].values;
    topics_[i].stamp = messages[i].stamp;
    topics_[i].count = messages[i].count;
    topics_[i].writer = messages[i].writer;
  }
}

std::string Topics::name_of(int writer) const {
  return writer < 0 ? "the caller" : writers_[static_cast<std::size_t>(writer)];
}

void Topics::claim(Topic& topic) const {
  if (topic.writer != nobody) {
    throw InputError(name_of(writer_) + " writes topic '" + topic.name + "', which " +
                     name_of(topic.writer) + " writes already; keep one of the two");
  }
  topic.writer = writer_;
}

}  // namespace quadcore
