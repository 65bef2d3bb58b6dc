#include "flight_thread.hpp"

#include <cstdio>

#include "quadcore/plugin/error.hpp"

namespace quadcore::node {
namespace {

/// A followed clock that advances by more at once has jumped [s].
constexpr double longest_clock_step = 1;

/// Returns the numbers of a command; 0 = the model takes no commands.
std::size_t command_width(const Simulation& simulation) {
  return simulation.topics().find(Simulation::command_topic) < 0 ? 0 : simulation.command_width();
}

}  // namespace

FlightThread::FlightThread(Simulation& simulation, const FlightSettings& settings,
                           FlightListener& listener)
    : simulation_(simulation),
      settings_(settings),
      listener_(listener),
      answered_(simulation.topics().find(settings.answered)),
      paused_(settings.paused),
      commands_(command_width(simulation), settings.lockstep),
      command_watch_(settings.command_timeout),
      real_time_factor_(settings.real_time_factor),
      pacer_(simulation.dt(), settings.follows_clock ? 0 : settings.real_time_factor) {
  if (settings.lockstep && !(simulation.takes_commands() && answered_ >= 0)) {
    throw InputError(
        "lockstep needs a model with commands on topic vel_cmd and odometry on topic " +
        settings.answered +
        ". Add libmotorpid_plugin.so and libodometry_plugin.so, or run without lockstep.");
  }
  report_.time = simulation.time();
  thread_ = std::thread(&FlightThread::run, this);
}

FlightThread::~FlightThread() { end(); }

double FlightThread::count_odometry() const {
  return answered_ < 0 ? 0 : simulation_.topics()[static_cast<std::size_t>(answered_)].count;
}

void FlightThread::end() {
  {
    const Lock lock(mutex_);
    ending_ = true;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

void FlightThread::command(const CommandQueue::Command& command) {
  Lock lock(mutex_);
  commands_.take(command);
  if (!settings_.lockstep) {
    command_watch_.arrived(report_.time);
  } else if (may_step_with_command()) {
    step_with_command(lock);
  } else {
    changed_.notify_all();
  }
}

void FlightThread::set_paused(bool paused) {
  const Lock lock(mutex_);
  if (paused_ && !paused) joined_ = false;  // the followed clock has continued
  paused_ = paused;
  steps_allowed_ = 0;
  changed_.notify_all();
}

void FlightThread::set_real_time_factor(double factor) {
  const Lock lock(mutex_);
  real_time_factor_ = factor;
  pacer_ = Pacer(simulation_.dt(), factor);
  changed_.notify_all();
}

void FlightThread::clock(double time) {
  std::string jump;
  {
    const Lock lock(mutex_);
    jump = describe_clock_jump(time);
    if (!jump.empty()) joined_ = false;
    clock_ = time;
    changed_.notify_all();
  }
  if (!jump.empty()) listener_.warn(jump);
}

/// Describes a jump of the followed clock, which the flight joins without simulating the time
/// between; "" = the clock has just continued.
std::string FlightThread::describe_clock_jump(double time) const {
  if (!clock_ || !joined_ || (time >= *clock_ && time <= *clock_ + longest_clock_step)) return "";
  char text[120];
  std::snprintf(text, sizeof text,
                "/clock jumped from %g to %g s. The flight continues there; its motion is kept.",
                *clock_, time);
  return text;
}

void FlightThread::hold(double time) {
  const Lock lock(mutex_);
  hold_ = time;
  changed_.notify_all();
}

void FlightThread::step(std::int64_t n) {
  if (settings_.follows_clock) {
    throw InputError("This vehicle follows /clock. Step the node that leads it.");
  }
  const Lock one_at_a_time(stepping_, std::try_to_lock);
  if (!one_at_a_time) throw InputError("Another step is running. Wait for it, or pause.");
  Lock lock(mutex_);
  paused_ = true;  // like Gazebo, instead of an error
  const std::int64_t goal = report_.steps + n;
  if (failure_.empty()) steps_allowed_ = n;
  changed_.notify_all();
  changed_.wait(lock, [this] { return steps_allowed_ == 0 || ending_; });
  if (!failure_.empty()) throw FlightError(report_.time, failure_);
  if (report_.steps >= goal) return;
  throw InputError("Stopped " + std::to_string(goal - report_.steps) + " steps before the end.");
}

void FlightThread::run_between_steps(const std::function<void(Simulation&)>& change) {
  run_in_flight([&] { change(simulation_); });
}

void FlightThread::change(const std::function<void(Simulation&)>& change) { jump(change, false); }

void FlightThread::reset(const std::function<void(Simulation&)>& change) { jump(change, true); }

void FlightThread::jump(const std::function<void(Simulation&)>& change, bool forget_commands) {
  run_in_flight([&] {
    change(simulation_);
    {
      const Lock lock(mutex_);
      if (forget_commands) commands_.forget();
      failure_.clear();
      report_.time = simulation_.time();
    }
    observe_jump();
  });
}

void FlightThread::run_in_flight(const std::function<void()>& action) {
  std::packaged_task<void()> task(action);
  std::future<void> done = task.get_future();
  {
    const Lock lock(mutex_);
    if (ending_) throw InputError("The node is shutting down.");
    changes_.push_back(std::move(task));
    changed_.notify_all();
  }
  done.get();
}

FlightReport FlightThread::report() const {
  const Lock lock(mutex_);
  FlightReport report = report_;
  const bool sets_the_pace = !settings_.lockstep && !settings_.follows_clock;
  report.real_time_factor = sets_the_pace ? real_time_factor_ : 0;
  report.commands = commands_.taken_count();
  report.waiting_commands = commands_.waiting_count();
  report.late_commands = settings_.lockstep ? commands_.late_count() : command_watch_.late_count();
  report.commands_stopped =
      settings_.lockstep ? commands_.has_given_up() : command_watch_.have_stopped();
  report.paused = paused_;
  report.waits_for_clock = settings_.follows_clock && !clock_;
  report.waits_for_command = settings_.lockstep && !commands_.has_begun() && may_step();
  report.failure = failure_;
  return report;
}

}  // namespace quadcore::node
