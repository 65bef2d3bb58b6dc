#include <algorithm>

#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/topics.hpp"
#include "quadcore/text.hpp"

/// \file
/// Whether what plugins declare of topics agrees, and the order in which they run then.

namespace quadcore {
namespace {

std::string describe(const MessageKind& kind) {
  return "'" + kind.name + "' (" + joined(kind.fields) + ")";
}

}  // namespace

void Topics::add_plugin(const std::string& name, const std::string& who) {
  plugins_.push_back({name, who});
}

std::vector<std::size_t> Topics::settle() {
  for (const Declaration& declared : declarations_) {
    Topic& topic = topics_[declared.topic];
    if (!declared.writes) {
      topic.readers.push_back(declared.plugin);
      continue;
    }
    if (topic.writer != the_caller) refuse_second(name_of(declared.plugin), topic);
    topic.writer = declared.plugin;
  }
  for (Declaration& declared : declarations_) {
    if (declared.open) close(declared);
  }
  for (const Declaration& declared : declarations_) {
    const Declaration& other = authority(declared.topic);
    topics_[declared.topic].kind.meaning = other.kind.meaning;
    if (other.kind == declared.kind) continue;
    throw InputError(name_of(declared.plugin) + " has topic '" + topics_[declared.topic].name +
                     "' as " + describe(declared.kind) + ", but " + name_of(other.plugin) +
                     " has it as " + describe(other.kind) + "; make them agree");
  }
  hold_what_is_unsaid();
  return order();
}

/// Fills each topic with the numbers that its readers assume before the first message.
void Topics::hold_what_is_unsaid() {
  for (const Declaration& declared : declarations_) {
    const std::vector<double>& unsaid = declared.kind.unsaid;
    Topic& topic = topics_[declared.topic];
    if (unsaid.empty()) continue;
    std::vector<double>& known = topic.kind.unsaid;
    if (unsaid.size() != topic.values.size() || (!known.empty() && known != unsaid)) {
      throw InputError(name_of(declared.plugin) + " has other numbers of topic '" + topic.name +
                       "' before the first message than " +
                       name_of(authority(declared.topic).plugin) +
                       "; give one for each field, and let them agree");
    }
    topic.values = known = unsaid;
  }
  for (const LateCopy& late : late_) {
    topics_[late.copy].kind.unsaid = topics_[late.original].kind.unsaid;
    topics_[late.copy].values = topics_[late.original].values;
  }
}

/// Gives a topic the fields of the first who takes it as this kind.
void Topics::close(Declaration& open) {
  const auto takes = [&](const Declaration& other) {
    return other.topic == open.topic && !other.writes && other.kind.name == open.kind.name;
  };
  const auto taker = std::find_if(declarations_.begin(), declarations_.end(), takes);
  if (taker != declarations_.end()) open.kind = taker->kind;
  Topic& topic = topics_[open.topic];
  topic.kind = open.kind;
  topic.values.assign(open.kind.fields.size(), 0.0);
}

/// The declaration that defines the kind of a topic: its writer's, or else its first reader's.
const Topics::Declaration& Topics::authority(std::size_t topic) const {
  const Declaration* first = nullptr;
  for (const Declaration& declared : declarations_) {
    if (declared.topic != topic) continue;
    if (declared.writes) return declared;
    if (!first) first = &declared;
  }
  return *first;
}

/// Of the plugins that wait for no other, the first by name comes next.
std::vector<std::size_t> Topics::order() const {
  std::vector<std::size_t> order;
  std::vector<bool> placed(plugins_.size(), false);
  while (order.size() < plugins_.size()) {
    int next = -1;
    for (std::size_t i = 0; i < plugins_.size(); ++i) {
      if (placed[i] || awaited(i, placed)) continue;
      if (next < 0 || plugins_[i].name < plugins_[static_cast<std::size_t>(next)].name) {
        next = static_cast<int>(i);
      }
    }
    if (next < 0) refuse_loop(placed);
    order.push_back(static_cast<std::size_t>(next));
    placed[order.back()] = true;
  }
  return order;
}

/// What a plugin takes from one that is not placed yet; null for nothing.
const Topics::Declaration* Topics::awaited(std::size_t plugin,
                                           const std::vector<bool>& placed) const {
  for (const Declaration& declared : declarations_) {
    const int writer = topics_[declared.topic].writer;
    if (declared.plugin == static_cast<int>(plugin) && !declared.writes && !declared.late &&
        writer != the_caller && writer != declared.plugin &&
        !placed[static_cast<std::size_t>(writer)]) {
      return &declared;
    }
  }
  return nullptr;
}

/// All plugins without a place wait for one another, so that following them ends in a loop.
void Topics::refuse_loop(const std::vector<bool>& placed) const {
  const auto unplaced = std::find(placed.begin(), placed.end(), false) - placed.begin();
  auto plugin = static_cast<std::size_t>(unplaced);
  const auto writer = [&](std::size_t reader) {
    return static_cast<std::size_t>(topics_[awaited(reader, placed)->topic].writer);
  };
  for (std::size_t i = 0; i < plugins_.size(); ++i) plugin = writer(plugin);
  std::string loop;
  std::size_t next = plugin;
  do {
    loop += (loop.empty() ? "" : ", and ") + plugins_[next].who + " takes topic '" +
            topics_[awaited(next, placed)->topic].name + "' from '" + plugins_[writer(next)].name +
            "'";
    next = writer(next);
  } while (next != plugin);
  throw InputError(loop + ": each waits for the other's value of the same sample; remove one, or " +
                   "let it take its topic a sample late");
}

}  // namespace quadcore
