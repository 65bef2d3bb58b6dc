#include <sys/prctl.h>

#include <algorithm>
#include <cstdio>

#include "flight_thread.hpp"
#include "quadcore/plugin/error.hpp"

/// \file
/// The flight's own thread.

namespace quadcore::node {
namespace {

/// Maximum sleep, so that a slow simulation still responds quickly.
constexpr auto longest_sleep = std::chrono::milliseconds(20);
/// After this time, both sides have a new connection, also on a busy machine.
constexpr auto time_to_connect = std::chrono::milliseconds(300);
/// Time without a commanding node before each reminder.
constexpr auto time_between_reminders = std::chrono::seconds(5);
/// After this time, the first answer counts as lost.
constexpr auto time_to_begin = std::chrono::seconds(10);
/// Maximum number of steps between two odometry messages that a command makes itself.
constexpr int most_steps_with_command = 100;
/// Rounding difference of two clocks, as a part of a step.
constexpr double rounding = 1e-3;

/// Call in a catch block. Describes why a state was not sent.
std::string describe_send_failure(const Simulation& simulation) {
  char text[100];
  std::snprintf(text, sizeof text, "cannot send the state at t = %g s: ", simulation.time());
  return text + what_was_thrown();
}

void apply_command(const CommandQueue::Command& command, Simulation& simulation) {
  const std::vector<double>& speeds = command.speeds;
  if (command.topic == Simulation::command_topic) {
    simulation.command(speeds.data(), speeds.size());
  } else {
    simulation.publish(command.topic, speeds.data(), speeds.size());
  }
}

}  // namespace

void FlightThread::run() {
  // By default, the kernel may delay a sleeping thread by 50 us to save wake-ups.
  prctl(PR_SET_TIMERSLACK, 1000UL);
  if (!settings_.follows_clock) {
    Lock lock(mutex_);
    unlocked(lock, [this] { observe_jump(); });
  }
  while (wait_until_due()) take_step();
}

/// Releases the lock while `action` runs. A failure ends the flight, not the node.
template <class Action>
void FlightThread::unlocked(Lock& lock, const Action& action) {
  lock.unlock();
  try {
    action();
  } catch (...) {
    fail(describe_send_failure(simulation_));
  }
  lock.lock();
}

/// Waits until the next step may begin. Returns false at the end.
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
    } else if (settings_.lockstep && commands_.is_awaited()) {
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

/// Waits for a condition, and returns whether it holds. It does not use changed_.wait_for alone,
/// because before GCC 10 a jump of the wall clock would make a command late.
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

/// Sets the simulation to the clock's time: at the start, after a pause, and if the clock was set
/// back. During a flight, only the time changes, and the motion stays bit-identical.
void FlightThread::join_clock(Lock& lock) {
  joined_ = true;
  const double time = *clock_;
  report_.time = time;
  command_watch_.restart();
  const bool starts = !jump_observed_;
  unlocked(lock, [&] {
    if (starts) {
      VehicleState start = simulation_.state();
      start.time = time;
      simulation_.set_state(start);  // sensors start at this time
      observe_jump();
    } else {
      Snapshot snapshot = simulation_.snapshot();
      snapshot.start_time += time - simulation_.time();
      simulation_.restore(snapshot);
    }
  });
}

/// Observes the start or a jump; in lockstep only when a node can answer. A controller that is
/// still connecting might get the odometry while its answer is lost, and both would wait.
void FlightThread::observe_jump() {
  const bool observe = !settings_.lockstep || listener_.has_commander();
  {
    const Lock lock(mutex_);
    commands_.begin();
    command_watch_.restart();
    jump_observed_ = observe;
    if (observe && count_odometry() > 0) commands_.message_sent();
  }
  if (observe) {
    listener_.observe(simulation_, true);
  } else {
    listener_.show(simulation_);
  }
}

void FlightThread::wait_for_commander(Lock& lock) {
  const auto must_stop = [this] { return is_interrupted(); };
  const Pacer::Clock::time_point now = Pacer::Clock::now();
  if (listener_.has_commander()) {
    reminded_.reset();
    if (!wait(lock, time_to_connect, must_stop)) unlocked(lock, [this] { observe_jump(); });
  } else if (!reminded_) {
    reminded_ = now;
  } else if (now - *reminded_ > time_between_reminders) {
    reminded_ = now;
    unlocked(lock, [this] { listener_.remind(simulation_); });
  } else {
    wait(lock, longest_sleep, must_stop);
  }
}

void FlightThread::wait_for_command(Lock& lock) {
  const bool may_begin_late = !commands_.has_begun() && !commands_.is_unsettled();
  const std::chrono::duration<double> timeout(settings_.lockstep_timeout);
  const std::int64_t taken = commands_.taken_count();
  // After each command, the controller has the full timeout for the next one.
  const auto has_news = [&] { return commands_.taken_count() != taken || is_interrupted(); };
  lends_ = true;
  wait(lock, may_begin_late ? time_to_begin : timeout, has_news);
  lends_ = false;
  while (is_lent_) changed_.wait_for(lock, longest_sleep);
  if (!has_news() && !commands_.settle()) {
    if (commands_.has_begun()) {
      commands_.give_up_late();
      char text[120];
      std::snprintf(text, sizeof text,
                    "lockstep: no command within %g s after the odometry of t = %g s. The last "
                    "command is kept.",
                    settings_.lockstep_timeout, report_.time);
      unlocked(lock, [&] { listener_.warn(text); });
    } else {
      commands_.give_up();
      commands_.message_sent();
      unlocked(lock, [this] {
        listener_.warn("lockstep: no first command yet. The odometry is sent again.");
        listener_.repeat(simulation_);
      });
    }
  }
  // The flight does not catch up after a wait for the controller.
  if (pacer_.due() < Pacer::Clock::now()) pacer_.restart();
}

/// Whether a command may make steps itself, which saves two hand-overs between threads for each
/// message: if the flight's thread waits for it, no other command makes steps, and the thread would
/// not have to wait after it.
bool FlightThread::may_step_with_command() const {
  return lends_ && !is_lent_ && real_time_factor_ == 0 && !settings_.follows_clock &&
         !listener_.waits_to_feed();
}

/// Makes the steps up to the next odometry message in the thread of the command, while the flight's
/// thread waits. Further steps are left to that thread.
void FlightThread::step_with_command(Lock& lock) {
  is_lent_ = true;
  const double count_before = count_odometry();
  for (int i = 0; i < most_steps_with_command && count_odometry() == count_before; ++i) {
    if (is_interrupted() || commands_.is_awaited() || simulation_.time() > hold_) break;
    lock.unlock();
    take_step();
    lock.lock();
  }
  is_lent_ = false;
  if (is_interrupted() || !commands_.is_awaited()) changed_.notify_all();
}

void FlightThread::run_changes(Lock& lock) {
  if (clock_ && !may_step()) join_clock(lock);  // a paused flight is behind the clock
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
  Lock lock(mutex_);
  report_.time = simulation_.time();
  ++report_.steps;
  if (steps_allowed_ > 0 && --steps_allowed_ == 0) changed_.notify_all();
  // Without a limit of the pace, simulated time says nothing about a controller.
  const bool has_pace = settings_.follows_clock || real_time_factor_ > 0;
  if (settings_.lockstep || !has_pace || !command_watch_.check(report_.time)) return;
  char text[120];
  std::snprintf(text, sizeof text,
                "no command since t = %g s: the controller has stopped. Its last command is kept.",
                command_watch_.last_arrival());
  lock.unlock();
  listener_.warn(text);
}

/// Returns the error; "" = no error.
std::string FlightThread::try_step() {
  std::optional<CommandQueue::Command> command;
  {
    const Lock lock(mutex_);
    report_.overruns += pacer_.begin_step();
    command = commands_.next();
  }
  try {
    if (command) apply_command(*command, simulation_);
  } catch (const InputError& error) {  // a plugin commands the rotors: the flight continues
    listener_.warn(error.what());
  }
  const double count_before = count_odometry();
  try {
    listener_.feed(simulation_);
    simulation_.step();
  } catch (...) {
    return what_was_thrown();
  }
  if (count_odometry() != count_before) {
    const Lock lock(mutex_);
    commands_.message_sent();  // before it is sent, because its answer may come at once
  }
  try {
    listener_.observe(simulation_, false);
  } catch (...) {
    return describe_send_failure(simulation_);
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
  listener_.warn(why + "; reset or set a state to continue");
}

}  // namespace quadcore::node
