#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace quadcore::node {

/// Queue of commands between the topic and the steps that apply them.
///
/// Without lockstep, a step applies the last command. In lockstep, command k answers odometry
/// message k, and early commands wait in order. Commands have no stamp, so the queue counts them.
/// After a timeout or a jump, the answer to the old message may still arrive, and must not count as
/// the answer to the next one. But the controller may also have skipped the message. A command that
/// arrives while answers are missing is therefore set aside. If no other follows, it was the answer
/// to the latest message.
///
/// Not synchronised: the owner's lock guards it.
class CommandQueue {
 public:
  struct Command {
    std::string topic;  ///< topic of the simulation
    std::vector<double> speeds;
  };

  /// Maximum number of waiting commands: ten seconds at 1 kHz.
  static constexpr std::size_t max_waiting = 10000;

  /// \param width  numbers of a command; 0 = the model takes no commands
  CommandQueue(std::size_t width, bool lockstep) : width_(width), lockstep_(lockstep) {}

  /// Takes a command. Throws InputError without a change if the count is wrong, if a number is not
  /// finite or too large, or if too many commands wait.
  void take(const Command& command);
  /// Call when an odometry message is sent.
  void message_sent();
  /// Stops waiting for waits for the answer to the last message, which may still arrive.
  void give_up();
  /// Does the same, and counts the answer as late.
  void give_up_late();
  /// Call after a timeout. Uses the command that was set aside, and returns whether there was one.
  bool settle();
  /// Call at the start and after a jump to another state.
  void begin();
  /// Discards all waiting commands.
  void forget();
  /// Removes and returns the command for the next step, if there is a new one.
  std::optional<Command> next();

  bool is_awaited() const { return awaited_; }  ///< the answer to the last message
  bool is_unsettled() const { return set_aside_.has_value(); }
  bool has_begun() const { return begun_; }  ///< a command has arrived since begin()
  std::int64_t taken_count() const { return taken_; }
  std::int64_t late_count() const {
    return late_;
  }  ///< in lockstep: messages without an answer in time
  bool has_given_up() const { return gave_up_; }  ///< in lockstep, since the last command
  std::size_t waiting_count() const { return waiting_.size(); }

 private:
  void set_next(Command command);

  const std::size_t width_;
  const bool lockstep_;
  bool begun_ = false;
  bool awaited_ = false;
  std::int64_t owed_ = 0;             ///< missing answers to earlier messages
  std::optional<Command> set_aside_;  ///< the last command since the last message
  std::deque<Command> waiting_;       ///< answers to future messages
  std::optional<Command> next_;
  bool gave_up_ = false;
  std::int64_t taken_ = 0;
  std::int64_t late_ = 0;
};

}  // namespace quadcore::node
