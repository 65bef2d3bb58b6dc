#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace quadcore::node {

/// Which odometry message a command answers. Commands carry no stamp, so they are counted: a
/// controller answers the messages in their order with one command each. The answer to a message
/// that was given up, at a timeout or a jump, may still come and must not be taken for that to the
/// next message; but a controller may also have skipped the message. So a command that comes while
/// answers are owed is set aside, and if none follows it, it was the latest message's answer.
class Answers {
 public:
  using Command = std::vector<double>;

  /// A message goes out.
  void message_sent() {
    awaited_ = true;
    set_aside_.reset();
  }
  /// A command has come. Returns whether it answers the message sent last.
  bool take(const Command& command) {
    if (owed_ == 0) return std::exchange(awaited_, false);
    --owed_;
    if (awaited_) set_aside_ = command;
    return false;
  }
  /// Nothing has come for long. Returns the command that was the answer after all, if one has come.
  std::optional<Command> settle() {
    if (set_aside_) {
      owed_ = 0;
      awaited_ = false;
    }
    return std::exchange(set_aside_, std::nullopt);
  }
  /// The answer to the message sent last is waited for no longer.
  void give_up() {
    owed_ += awaited_;
    awaited_ = false;
    set_aside_.reset();
  }
  bool awaited() const { return awaited_; }
  bool unsettled() const { return set_aside_.has_value(); }

 private:
  bool awaited_ = false;              ///< that to the message sent last
  std::int64_t owed_ = 0;             ///< to messages given up
  std::optional<Command> set_aside_;  ///< the last that came since the message sent last
};

}  // namespace quadcore::node
