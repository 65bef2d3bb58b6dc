#include "command_queue.hpp"

#include <string>
#include <utility>

#include "quadcore/commands.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::node {

void CommandQueue::take(const Command& command) {
  if (width_ == 0) throw InputError("The model takes no commands. Add libmotorpid_plugin.so.");
  check_command(command.speeds.data(), command.speeds.size(), width_, Simulation::max_rate);
  if (!lockstep_ || (owed_ == 0 && awaited_)) {
    awaited_ = false;
    set_next(command);
  } else if (owed_ > 0) {
    --owed_;
    if (awaited_) set_aside_ = command;
  } else if (waiting_.size() < max_waiting) {
    waiting_.push_back(command);
  } else {
    throw InputError("lockstep: " + std::to_string(max_waiting) +
                     " commands already wait for odometry, and one more is dropped. Send one "
                     "command for each message.");
  }
  ++taken_;
}

void CommandQueue::message_sent() {
  if (lockstep_ && begun_ && awaited_) ++late_;
  set_aside_.reset();
  awaited_ = waiting_.empty();
  if (awaited_) return;
  set_next(std::move(waiting_.front()));
  waiting_.pop_front();
}

void CommandQueue::give_up() {
  owed_ += awaited_;
  awaited_ = false;
  set_aside_.reset();
}

void CommandQueue::give_up_late() {
  give_up();
  ++late_;
  gave_up_ = true;
}

bool CommandQueue::settle() {
  if (!set_aside_) return false;
  owed_ = 0;
  awaited_ = false;
  set_next(std::move(*set_aside_));
  set_aside_.reset();
  return true;
}

void CommandQueue::begin() {
  begun_ = false;
  if (lockstep_) give_up();  // commands on their way answer the previous state
}

void CommandQueue::forget() {
  next_.reset();
  waiting_.clear();
}

std::optional<CommandQueue::Command> CommandQueue::next() {
  return std::exchange(next_, std::nullopt);
}

void CommandQueue::set_next(Command command) {
  next_ = std::move(command);
  begun_ = true;
  gave_up_ = false;
}

}  // namespace quadcore::node
