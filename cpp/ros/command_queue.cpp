#include "command_queue.hpp"

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "quadcore/error.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::node {
namespace {

void check(const CommandQueue::Command& speeds, std::size_t width) {
  if (width == 0) throw InputError("the model takes no commands; add libmotorpid_plugin.so");
  if (speeds.size() != width) {
    throw InputError("a command of " + std::to_string(speeds.size()) + " numbers; send " +
                     std::to_string(width) + " rotor speeds in rad/s");
  }
  for (const double speed : speeds) {
    if (!std::isfinite(speed)) {
      throw InputError("a command with a number that is not finite; send rad/s");
    }
    if (std::abs(speed) > Simulation::max_rate) {
      char text[100];
      std::snprintf(text, sizeof text, "a command with a number beyond %g rad/s, where a flight",
                    Simulation::max_rate);
      throw InputError(std::string(text) + " counts as diverged; send rad/s");
    }
  }
}

}  // namespace

void CommandQueue::take(const Command& command) {
  check(command, width_);
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
