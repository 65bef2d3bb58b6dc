#include "command_queue.hpp"

#include <string>
#include <utility>

#include "quadcore/commands.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::node {

void CommandQueue::take(const Command& command) {
  if (width_ == 0) throw InputError("the model takes no commands; add libmotorpid_plugin.so");
  check_command(command.speeds.data(), command.speeds.size(), width_, Simulation::max_rate);
  if (!lockstep_ || (owed_ == 0 && awaited_)) {
    awaited_ = false;
    fly(command);
  } else if (owed_ > 0) {
    --owed_;
    if (awaited_) set_aside_ = command;
  } else if (waiting_.size() < most_waiting) {
    waiting_.push_back(command);
  } else {
    throw InputError("lockstep: " + std::to_string(most_waiting) +
                     " commands wait for their odometry already, and one more is dropped; send "
                     "one for each message");
  }
  ++taken_;
}

void CommandQueue::message_sent() {
  if (begun_ && awaited_) ++late_;
  set_aside_.reset();
  awaited_ = waiting_.empty();
  if (awaited_) return;
  fly(std::move(waiting_.front()));
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
}

bool CommandQueue::settle() {
  if (!set_aside_) return false;
  owed_ = 0;
  awaited_ = false;
  fly(std::move(*set_aside_));
  set_aside_.reset();
  return true;
}

void CommandQueue::begin() {
  begun_ = false;
  if (lockstep_) give_up();  // what is on its way answers the state before
}

void CommandQueue::forget() {
  next_.reset();
  waiting_.clear();
}

std::optional<CommandQueue::Command> CommandQueue::next() {
  return std::exchange(next_, std::nullopt);
}

void CommandQueue::fly(Command command) {
  next_ = std::move(command);
  begun_ = true;
}

}  // namespace quadcore::node
