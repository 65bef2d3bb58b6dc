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
  if (command_width_ == 0) {
    throw InputError("the model takes no commands; add libmotorpid_plugin.so");
  }
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
  const bool is_answer = answers_.take(speeds);
  if (settings_.lockstep) {
    changed_.notify_all();
    // A second command for one message would act or not, as chance has it.
    if (!is_answer || !jump_observed_) return;
  }
  command_ = speeds;
  commanded_ = command_waits_ = true;
}

void FlightThread::set_paused(bool paused) {
  const Lock lock(mutex_);
  paused_ = paused;
  steps_allowed_ = 0;
  changed_.notify_all();
}

void FlightThread::step(std::int64_t n) {
  const Lock one_at_a_time(stepping_, std::try_to_lock);
  if (!one_at_a_time) throw InputError("another step is under way; wait for it or pause");
  Lock lock(mutex_);
  paused_ = true;  // as Gazebo does, rather than refuse
  const std::int64_t goal = report_.steps + n;
  if (failure_.empty()) steps_allowed_ = n;
  changed_.notify_all();
  changed_.wait(lock, [this] { return steps_allowed_ == 0 || ending_; });
  if (!failure_.empty()) throw FlightError(report_.time, failure_);
  if (report_.steps >= goal) return;
  throw InputError("stopped with " + std::to_string(goal - report_.steps) + " steps to go");
}

void FlightThread::change(const std::function<void(Simulation&)>& change) { run(change, false); }

void FlightThread::reset(const std::function<void(Simulation&)>& change) { run(change, true); }

void FlightThread::run(const std::function<void(Simulation&)>& change, bool forget_command) {
  std::packaged_task<void()> task([this, &change, forget_command] {
    change(simulation_);
    {
      const Lock lock(mutex_);
      if (forget_command) command_waits_ = false;
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
  report.waiting = waits_to_begin();
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
    } else if (settings_.lockstep && !jump_observed_) {
      wait_for_commander(lock);
    } else if (settings_.lockstep && answers_.awaited()) {
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

/// Observes the start or a jump; in lockstep only once someone can answer. A controller that is
/// still connecting would see the odometry, but its answer would be lost, and both would wait.
void FlightThread::observe_jump() {
  const bool observe = !settings_.lockstep || listener_.has_commander();
  {
    const Lock lock(mutex_);
    commanded_ = false;
    jump_observed_ = observe;
    // What is on its way answers the state before.
    if (settings_.lockstep) answers_.give_up();
    if (observe) answers_.message_sent();
  }
  if (observe) listener_.observe(simulation_, true);
}

void FlightThread::wait_for_commander(Lock& lock) {
  const auto is_disturbed = [this] { return disturbed(); };
  if (!listener_.has_commander()) {
    wait(lock, longest_sleep, is_disturbed);
  } else if (!wait(lock, time_to_connect, is_disturbed)) {
    lock.unlock();
    observe_jump();
    lock.lock();
  }
}

void FlightThread::wait_for_command(Lock& lock) {
  const bool may_begin_late = !commanded_ && !answers_.unsettled();
  const std::chrono::duration<double> timeout(settings_.lockstep_timeout);
  const std::int64_t commands = report_.commands;
  // Each command gives the controller the whole time for the next one.
  const auto has_news = [&] { return report_.commands != commands || disturbed(); };
  if (!wait(lock, may_begin_late ? time_to_begin : timeout, has_news)) {
    if (std::optional<Answers::Command> command = answers_.settle()) {
      command_ = std::move(*command);
      commanded_ = command_waits_ = true;
    } else if (!commanded_) {
      repeat_message(lock);
    } else {
      answers_.give_up();
      ++report_.late_commands;
      char text[100];
      std::snprintf(text, sizeof text,
                    "lockstep: no command within %g s after the odometry of t = %g s",
                    settings_.lockstep_timeout, report_.time);
      listener_.warn(std::string(text) + "; the last one is kept");
    }
  }
  // A wait for the controller is not made up for by rushing.
  if (pacer_.due() < Pacer::Clock::now()) pacer_.restart();
}

void FlightThread::repeat_message(Lock& lock) {
  listener_.warn("lockstep: still no first command; the odometry is sent again");
  answers_.give_up();
  answers_.message_sent();
  lock.unlock();
  listener_.repeat(simulation_);
  lock.lock();
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
  const std::size_t warnings_before = simulation_.warnings().size();
  std::string failure;
  try {
    simulation_.step();
  } catch (const FlightError& error) {
    failure = error.what();
  }
  for (std::size_t i = warnings_before; i < simulation_.warnings().size(); ++i) {
    listener_.warn(simulation_.warnings()[i]);
  }
  if (failure.empty() && odometry_count(simulation_, odometry_topic_) != odometry_before) {
    const Lock lock(mutex_);
    if (commanded_ && answers_.awaited()) ++report_.late_commands;
    // Before the message goes out: its answer may come at once.
    answers_.message_sent();
  }
  if (failure.empty()) listener_.observe(simulation_, false);

  const Lock lock(mutex_);
  failure_ = failure;
  report_.time = simulation_.time();
  if (failure_.empty()) {
    ++report_.steps;
    if (steps_allowed_ > 0) --steps_allowed_;
  } else {
    steps_allowed_ = 0;
    listener_.warn(failure_ + "; reset or set a state to go on");
  }
  if (steps_allowed_ == 0) changed_.notify_all();
}

}  // namespace quadcore::node
