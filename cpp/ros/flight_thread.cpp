#include "flight_thread.hpp"

#include <sys/prctl.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "quadcore/error.hpp"

namespace quadcore::node {
namespace {

/// The longest sleep, so that a slow simulation still hears at once what is asked of it.
constexpr auto longest_sleep = std::chrono::milliseconds(20);
/// After this a connection that this side has is one that the other side has, too.
constexpr auto time_to_connect = std::chrono::milliseconds(100);
/// No controller takes so long for its first answer: it must have been lost.
constexpr auto time_to_begin = std::chrono::seconds(10);

double odometry_count(const Simulation& simulation, int topic) {
  return topic < 0 ? 0 : simulation.topics()[static_cast<std::size_t>(topic)].count;
}

}  // namespace

FlightThread::FlightThread(Simulation& simulation, const FlightSettings& settings,
                           FlightListener& listener)
    : simulation_(simulation),
      settings_(settings),
      listener_(listener),
      command_width_(simulation.topics().find("vel_cmd") < 0 ? 0 : simulation.command_width()),
      odometry_topic_(simulation.topics().find("odom")),
      paused_(settings.paused),
      pacer_(simulation.dt(), settings.real_time_factor) {
  if (settings.lockstep && (command_width_ == 0 || odometry_topic_ < 0)) {
    throw InputError(
        "lockstep needs a model that takes commands and sends odometry; add "
        "libmotorpid_plugin.so and libodometry_plugin.so, or leave lockstep off");
  }
  report_.time = simulation.time();
  thread_ = std::thread(&FlightThread::fly, this);
}

FlightThread::~FlightThread() { end(); }

void FlightThread::end() {
  {
    const Lock lock(mutex_);
    ending_ = true;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

void FlightThread::command(const std::vector<double>& speeds) {
  if (speeds.size() != command_width_) {
    throw InputError("a command of " + std::to_string(speeds.size()) + " numbers; send " +
                     std::to_string(command_width_) + " rotor speeds in rad/s");
  }
  for (const double speed : speeds) {
    if (!std::isfinite(speed)) {
      throw InputError("a command with a number that is not finite; send rad/s");
    }
  }
  const Lock lock(mutex_);
  ++report_.commands;
  // In lockstep only the first answer to an odometry message counts: what came after it would act
  // or not, as chance has it.
  if (settings_.lockstep && answered_) return;
  command_ = speeds;
  commanded_ = command_waits_ = answered_ = true;
  if (settings_.lockstep) changed_.notify_all();
}

void FlightThread::set_paused(bool paused) {
  const Lock lock(mutex_);
  paused_ = paused;
  steps_allowed_ = 0;
  changed_.notify_all();
}

void FlightThread::step(std::int64_t n) {
  const Lock one_at_a_time(stepping_);
  Lock lock(mutex_);
  paused_ = true;  // as Gazebo does, rather than refuse
  const std::int64_t goal = report_.steps + n;
  steps_allowed_ = n;
  changed_.notify_all();
  changed_.wait(lock, [this] { return steps_allowed_ == 0 || ending_ || !failure_.empty(); });
  if (report_.steps >= goal) return;
  if (!failure_.empty()) throw FlightError(report_.time, failure_);
  throw InputError("stopped with " + std::to_string(goal - report_.steps) + " steps to go");
}

void FlightThread::change(const std::function<void(Simulation&)>& change) {
  std::packaged_task<void()> task([this, &change] {
    change(simulation_);
    {
      const Lock lock(mutex_);
      // What was commanded before is no answer to the state that is observed now.
      commanded_ = command_waits_ = answered_ = false;
      failure_.clear();
      report_.time = simulation_.time();
    }
    observe_jump();
  });
  std::future<void> done = task.get_future();
  {
    const Lock lock(mutex_);
    if (ending_) throw InputError("the node is ending");
    changes_.push_back(std::move(task));
    changed_.notify_all();
  }
  done.get();
}

FlightReport FlightThread::report() const {
  const Lock lock(mutex_);
  FlightReport report = report_;
  report.paused = paused_;
  report.failure = failure_;
  return report;
}

void FlightThread::fly() {
  // The kernel may delay a sleeping thread by 50 us to save wake-ups; here they are the work.
  prctl(PR_SET_TIMERSLACK, 1000UL);
  observe_jump();
  while (wait_until_due()) take_step();
}

/// Waits until the next step may begin; false at the end.
bool FlightThread::wait_until_due() {
  Lock lock(mutex_);
  for (;;) {
    if (!changes_.empty()) {
      run_changes(lock);
    } else if (ending_) {
      return false;
    } else if (!may_step()) {
      changed_.wait(lock);
      pacer_.restart();
    } else if (settings_.lockstep && !answered_) {
      wait_for_command(lock);
    } else {
      const auto now = Pacer::Clock::now();
      if (pacer_.due() <= now) return true;
      lock.unlock();
      // Not changed_.wait_until: before GCC 10 it would follow a jump of the wall clock.
      std::this_thread::sleep_until(std::min(pacer_.due(), now + longest_sleep));
      lock.lock();
    }
  }
}

/// Observes the start or a jump; in lockstep only once someone can answer. A controller that is
/// still connecting would see the odometry, but its answer would be lost, and both would wait.
void FlightThread::observe_jump() {
  const bool observe = !settings_.lockstep || listener_.has_commander();
  {
    const Lock lock(mutex_);
    jump_observed_ = observe;
  }
  if (observe) listener_.observe(simulation_, true);
}

void FlightThread::wait_for_first_command(Lock& lock) {
  const auto is_disturbed = [this] { return disturbed(); };
  if (jump_observed_) {
    if (changed_.wait_for(lock, time_to_begin, is_disturbed)) return;
    listener_.warn("lockstep: still no first command; the odometry is sent again");
    lock.unlock();
    listener_.repeat(simulation_);
    lock.lock();
  } else if (!listener_.has_commander()) {
    changed_.wait_for(lock, longest_sleep, is_disturbed);
  } else if (!changed_.wait_for(lock, time_to_connect, is_disturbed)) {
    lock.unlock();
    observe_jump();
    lock.lock();
  }
}

void FlightThread::wait_for_command(Lock& lock) {
  const std::chrono::duration<double> timeout(settings_.lockstep_timeout);
  if (!commanded_) {
    wait_for_first_command(lock);
  } else if (!changed_.wait_for(lock, timeout, [this] { return disturbed(); })) {
    answered_ = true;
    ++report_.late_commands;
    char text[100];
    std::snprintf(text, sizeof text,
                  "lockstep: no command within %g s after the odometry of t = %g s",
                  settings_.lockstep_timeout, report_.time);
    listener_.warn(std::string(text) + "; the last one is kept");
  }
  // A wait for the controller is not made up for by rushing.
  if (pacer_.due() < Pacer::Clock::now()) pacer_.restart();
}

void FlightThread::run_changes(Lock& lock) {
  while (!changes_.empty()) {
    std::packaged_task<void()> change = std::move(changes_.front());
    changes_.pop_front();
    lock.unlock();
    change();
    lock.lock();
  }
}

void FlightThread::take_step() {
  const bool overrun = pacer_.begin_step();
  {
    const Lock lock(mutex_);
    if (command_waits_) simulation_.command(command_.data(), command_.size());
    command_waits_ = false;
    report_.overruns += overrun;
  }
  const double odometry_before = odometry_count(simulation_, odometry_topic_);
  std::string failure;
  try {
    simulation_.step();
  } catch (const FlightError& error) {
    failure = error.what();
  }
  if (odometry_count(simulation_, odometry_topic_) != odometry_before) {
    const Lock lock(mutex_);
    if (commanded_ && !answered_) ++report_.late_commands;
    // Before the message goes out: its answer may come at once.
    answered_ = false;
  }
  if (failure.empty()) listener_.observe(simulation_, false);

  const Lock lock(mutex_);
  failure_ = failure;
  report_.time = simulation_.time();
  ++report_.steps;
  if (steps_allowed_ > 0) --steps_allowed_;
  if (steps_allowed_ == 0 || !failure_.empty()) changed_.notify_all();
  if (!failure_.empty()) listener_.warn(failure_ + "; reset or set a state to go on");
}

}  // namespace quadcore::node
