#include <sys/prctl.h>

#include <algorithm>
#include <cstdio>

#include "flight_thread.hpp"
#include "quadcore/plugin/error.hpp"

/// \file
/// What the flight's own thread does.

namespace quadcore::node {
namespace {

/// The longest sleep, so that a slow simulation still hears at once what is asked of it.
constexpr auto longest_sleep = std::chrono::milliseconds(20);
/// After this a connection that this side has is one that the other side has, too, on a busy
/// machine as well.
constexpr auto time_to_connect = std::chrono::milliseconds(300);
/// How long nobody may be there to send commands before it is said, and said again.
constexpr auto time_between_reminders = std::chrono::seconds(5);
/// No controller takes so long for its first answer: it must have been lost.
constexpr auto time_to_begin = std::chrono::seconds(10);
/// Part of a step by which two clocks may differ in rounding.
constexpr double rounding = 1e-3;

/// In a catch block: why what was to be observed was not.
std::string cannot_be_sent(const Simulation& simulation) {
  char text[100];
  std::snprintf(text, sizeof text, "the state of t = %g s cannot be sent: ", simulation.time());
  return text + what_was_thrown();
}

void fly_command(const CommandQueue::Command& command, Simulation& simulation) {
  const std::vector<double>& speeds = command.speeds;
  if (command.topic == Simulation::command_topic) {
    simulation.command(speeds.data(), speeds.size());
  } else {
    simulation.publish(command.topic, speeds.data(), speeds.size());
  }
}

}  // namespace

void FlightThread::fly() {
  // The kernel may delay a sleeping thread by 50 us to save wake-ups; here they are the work.
  prctl(PR_SET_TIMERSLACK, 1000UL);
  if (!settings_.follows_clock) {
    Lock lock(mutex_);
    unlocked(lock, [this] { observe_jump(); });
  }
  while (wait_until_due()) take_step();
}

/// Lets others in while `action` runs; a failure of it ends the flight, not the node.
template <class Action>
void FlightThread::unlocked(Lock& lock, const Action& action) {
  lock.unlock();
  try {
    action();
  } catch (...) {
    fail(cannot_be_sent(simulation_));
  }
  lock.lock();
}

/// Waits until the next step may begin; false at the end.
bool FlightThread::wait_until_due() {
  Lock lock(mutex_);
  for (;;) {
    const double step_end = simulation_.time() + (1 - rounding) * simulation_.dt();
    if (!changes_.empty()) {
      run_changes(lock);
    } else if (ending_) {
      return false;
    } else if (settings_.follows_clock && !joined_ && clock_) {
      join_clock(lock);
    } else if (!may_step()) {
      changed_.wait(lock);
      pacer_.restart();
    } else if (settings_.lockstep && !jump_observed_) {
      wait_for_commander(lock);
    } else if (settings_.lockstep && commands_.awaited()) {
      wait_for_command(lock);
    } else if (settings_.follows_clock) {
      if (clock_ && step_end <= *clock_) return true;
      changed_.wait(lock);
    } else if (simulation_.time() > hold_) {
      changed_.wait(lock);
      pacer_.restart();
    } else if (pacer_.due() <= Pacer::Clock::now()) {
      return true;
    } else {
      wait_for_pace(lock);
    }
  }
}

void FlightThread::wait_for_pace(Lock& lock) {
  const auto until = std::min(pacer_.due(), Pacer::Clock::now() + longest_sleep);
  lock.unlock();
  // Not changed_.wait_until: before GCC 10 it would follow a jump of the wall clock.
  std::this_thread::sleep_until(until);
  lock.lock();
}

/// Waits for a condition that a notice may bring about. Returns whether it holds. Not
/// changed_.wait_for alone: before GCC 10 a jump of the wall clock would make a command late.
template <class Condition>
bool FlightThread::wait(Lock& lock, std::chrono::duration<double> patience,
                        const Condition& condition) {
  const auto start = Pacer::Clock::now();
  while (!condition()) {
    const std::chrono::duration<double> left = patience - (Pacer::Clock::now() - start);
    if (left.count() <= 0) return false;
    changed_.wait_for(lock, std::min<std::chrono::duration<double>>(left, longest_sleep));
  }
  return true;
}

/// Brings the simulation to the clock's time: at the start, after a pause, and if the clock was set
/// back. Of a flight under way only the time changes, so no bit of the motion does.
void FlightThread::join_clock(Lock& lock) {
  joined_ = true;
  const double time = *clock_;
  report_.time = time;
  const bool starts = !jump_observed_;
  unlocked(lock, [&] {
    if (starts) {
      VehicleState start = simulation_.state();
      start.time = time;
      simulation_.set_state(start);  // sensors begin with it
      observe_jump();
    } else {
      Snapshot snapshot = simulation_.snapshot();
      snapshot.start_time += time - simulation_.time();
      simulation_.restore(snapshot);
    }
  });
}

/// Observes the start or a jump; in lockstep only once someone can answer. A controller that is
/// still connecting would see the odometry, but its answer would be lost, and both would wait.
void FlightThread::observe_jump() {
  const bool observe = !settings_.lockstep || listener_.has_commander();
  {
    const Lock lock(mutex_);
    commands_.begin();
    jump_observed_ = observe;
    if (observe && asked() > 0) commands_.message_sent();
  }
  if (observe) {
    listener_.observe(simulation_, true);
  } else {
    listener_.show(simulation_);
  }
}

void FlightThread::wait_for_commander(Lock& lock) {
  const auto is_disturbed = [this] { return disturbed(); };
  const Pacer::Clock::time_point now = Pacer::Clock::now();
  if (listener_.has_commander()) {
    reminded_.reset();
    if (!wait(lock, time_to_connect, is_disturbed)) unlocked(lock, [this] { observe_jump(); });
  } else if (!reminded_) {
    reminded_ = now;
  } else if (now - *reminded_ > time_between_reminders) {
    reminded_ = now;
    unlocked(lock, [this] { listener_.remind(simulation_); });
  } else {
    wait(lock, longest_sleep, is_disturbed);
  }
}

void FlightThread::wait_for_command(Lock& lock) {
  const bool may_begin_late = !commands_.begun() && !commands_.unsettled();
  const std::chrono::duration<double> timeout(settings_.lockstep_timeout);
  const std::int64_t taken = commands_.taken();
  // Each command gives the controller the whole time for the next one.
  const auto has_news = [&] { return commands_.taken() != taken || disturbed(); };
  if (!wait(lock, may_begin_late ? time_to_begin : timeout, has_news) && !commands_.settle()) {
    if (commands_.begun()) {
      commands_.give_up_late();
      char text[120];
      std::snprintf(text, sizeof text,
                    "lockstep: no command within %g s after the odometry of t = %g s; the last "
                    "one is kept",
                    settings_.lockstep_timeout, report_.time);
      unlocked(lock, [&] { listener_.warn(text); });
    } else {
      commands_.give_up();
      commands_.message_sent();
      unlocked(lock, [this] {
        listener_.warn("lockstep: still no first command; the odometry is sent again");
        listener_.repeat(simulation_);
      });
    }
  }
  // A wait for the controller is not made up for by rushing.
  if (pacer_.due() < Pacer::Clock::now()) pacer_.restart();
}

void FlightThread::run_changes(Lock& lock) {
  if (clock_ && !may_step()) join_clock(lock);  // what stands has fallen behind
  while (!changes_.empty()) {
    std::packaged_task<void()> change = std::move(changes_.front());
    changes_.pop_front();
    lock.unlock();
    change();
    lock.lock();
  }
}

void FlightThread::take_step() {
  const std::string failure = try_step();
  if (!failure.empty()) return fail(failure);
  const Lock lock(mutex_);
  report_.time = simulation_.time();
  ++report_.steps;
  if (steps_allowed_ > 0) --steps_allowed_;
  if (steps_allowed_ == 0) changed_.notify_all();
}

/// Returns what went wrong; "" = nothing.
std::string FlightThread::try_step() {
  std::optional<CommandQueue::Command> command;
  {
    const Lock lock(mutex_);
    report_.overruns += pacer_.begin_step();
    command = commands_.next();
  }
  try {
    if (command) fly_command(*command, simulation_);
  } catch (const InputError& error) {  // a plugin commands: it goes on
    listener_.warn(error.what());
  }
  const double asked_before = asked();
  try {
    listener_.feed(simulation_);
    simulation_.step();
  } catch (...) {
    return what_was_thrown();
  }
  if (asked() != asked_before) {
    const Lock lock(mutex_);
    commands_.message_sent();  // before it goes out: its answer may come at once
  }
  try {
    listener_.observe(simulation_, false);
  } catch (...) {
    return cannot_be_sent(simulation_);
  }
  return "";
}

void FlightThread::fail(const std::string& why) {
  {
    const Lock lock(mutex_);
    failure_ = why;
    report_.time = simulation_.time();
    steps_allowed_ = 0;
    changed_.notify_all();
  }
  listener_.warn(why + "; reset or set a state to go on");
}

}  // namespace quadcore::node
