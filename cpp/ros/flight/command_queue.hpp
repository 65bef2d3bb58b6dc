#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace quadcore::node {

/// Commands on their way from the topic to the steps that fly them.
///
/// Free-running, the last one that came is flown. In lockstep command k answers odometry message k:
/// those that come early wait in order. Commands carry no stamp, so they are counted. The answer to
/// a message that was given up, at a timeout or a jump, may still come and must not be taken for
/// that to the next message; but a controller may also have skipped the message. So a command that
/// comes while answers are owed is set aside, and if none follows it, it was the latest message's
/// answer.
///
/// Not synchronised: the owner's lock guards it.
class CommandQueue {
 public:
  struct Command {
    std::string topic;  ///< of the simulation
    std::vector<double> speeds;
  };

  /// Commands that wait for their message, at most: ten seconds at 1 kHz.
  static constexpr std::size_t most_waiting = 10000;

  /// \param width  numbers of a command; 0 = the model takes none
  CommandQueue(std::size_t width, bool lockstep) : width_(width), lockstep_(lockstep) {}

  /// A command has come. Throws InputError, nothing changed, on a wrong count, a number that is not
  /// finite or beyond every flight, or if too many wait already.
  void take(const Command& command);
  /// An odometry message goes out.
  void message_sent();
  /// The answer to the message sent last is waited for no longer; it may come all the same.
  void give_up();
  /// It has not come in time.
  void give_up_late();
  /// Nothing has come for long. Returns whether the command set aside was the answer after all.
  bool settle();
  /// The vehicle starts, or has jumped to another state.
  void begin();
  /// Commands that no step has flown are forgotten.
  void forget();
  /// The command that the next step is to change to, if any.
  std::optional<Command> next();

  bool awaited() const { return awaited_; }  ///< the answer to the last message
  bool unsettled() const { return set_aside_.has_value(); }
  bool begun() const { return begun_; }  ///< a command has come since begin()
  std::int64_t taken() const { return taken_; }
  std::int64_t late() const { return late_; }  ///< messages not answered in time
  std::size_t waiting() const { return waiting_.size(); }

 private:
  void fly(Command command);

  const std::size_t width_;
  const bool lockstep_;
  bool begun_ = false;
  bool awaited_ = false;
  std::int64_t owed_ = 0;             ///< answers to messages given up
  std::optional<Command> set_aside_;  ///< the last that came since the message sent last
  std::deque<Command> waiting_;       ///< answers to messages to come
  std::optional<Command> next_;
  std::int64_t taken_ = 0;
  std::int64_t late_ = 0;
};

}  // namespace quadcore::node
