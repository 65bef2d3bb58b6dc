#include <algorithm>

#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/topics.hpp"
#include "quadcore/text.hpp"

/// \file
/// Checks that the plugins' topic declarations agree and derives the order in which plugins run.

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
    const Declaration& other = find_authority(declared.topic);
    topics_[declared.topic].kind.meaning = other.kind.meaning;
    if (other.kind == declared.kind) continue;
    throw InputError(name_of(declared.plugin) + " declares topic '" + topics_[declared.topic].name +
                     "' as " + describe(declared.kind) + ", but " + name_of(other.plugin) +
                     " declares it as " + describe(other.kind) + ". Make the declarations agree.");
  }
  hold_what_is_unsaid();
  return order();
}

/// Fill each topic with the values that its readers assume before the first message.
void Topics::hold_what_is_unsaid() {
  for (const Declaration& declared : declarations_) {
    const std::vector<double>& unsaid = declared.kind.unsaid;
    Topic& topic = topics_[declared.topic];
    if (unsaid.empty()) continue;
    std::vector<double>& known = topic.kind.unsaid;
    if (unsaid.size() != topic.values.size() || (!known.empty() && known != unsaid)) {
      throw InputError(name_of(declared.plugin) + " and " +
                       name_of(find_authority(declared.topic).plugin) +
                       " assume different values of topic '" + topic.name +
                       "' before the first message. Give both the same value for each field.");
    }
    topic.values = known = unsaid;
  }
  for (const LateCopy& late : late_) {
    topics_[late.copy].kind.unsaid = topics_[late.original].kind.unsaid;
    topics_[late.copy].values = topics_[late.original].values;
  }
}

/// Give a topic the fields of its first reader that expects this kind.
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

/// Return the declaration that defines the kind of a topic: its writer's, or else its first
/// reader's.
const Topics::Declaration& Topics::find_authority(std::size_t topic) const {
  const Declaration* first = nullptr;
  for (const Declaration& declared : declarations_) {
    if (declared.topic != topic) continue;
    if (declared.writes) return declared;
    if (!first) first = &declared;
  }
  return *first;
}

/// Return the plugins in running order. Of the plugins that wait for no other, the first by name
/// comes next.
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

/// Return a declaration by which a plugin reads from one that is not placed yet, or null.
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

/// Report the loop of plugins that wait for one another; all plugins without a place lead into one.
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
    loop += (loop.empty() ? "" : ", and ") + plugins_[next].who + " reads topic '" +
            topics_[awaited(next, placed)->topic].name + "' from '" + plugins_[writer(next)].name +
            "'";
    next = writer(next);
  } while (next != plugin);
  throw InputError(loop +
                   ": each waits for the other's value of the same sample. Remove one, or let it "
                   "read its topic one sample late.");
}

}  // namespace quadcore
