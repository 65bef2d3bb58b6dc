#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "command_queue.hpp"
#include "command_watch.hpp"
#include "odometry_topic.hpp"
#include "pacer.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::node {

struct FlightSettings {
  double real_time_factor = 1;    ///< simulated seconds per second; 0 = as fast as possible
  bool follows_clock = false;     ///< clock() determines when steps are due
  bool paused = false;            ///< whether the flight starts paused
  bool lockstep = false;          ///< wait for one command per odometry message
  double lockstep_timeout = 1;    ///< time to wait for a command [s]
  double command_timeout = 0.05;  ///< without lockstep, until commands have stopped [s]; 0 = never
  std::string answered = OdometryTopic::name;  ///< topic of the simulation that commands answer
};

/// Receives the events of a flight. The thread that makes the steps makes all calls without holding
/// a lock.
class FlightListener {
 public:
  virtual ~FlightListener() = default;
  /// Called before a step: publishes received messages for the plugins.
  virtual void feed(Simulation& simulation) = 0;
  /// Whether feed() waits for another thread.
  virtual bool waits_to_feed() const = 0;
  /// Called after a step or, with `jumped`, after a reset or a new state.
  virtual void observe(const Simulation& simulation, bool jumped) = 0;
  /// Called while the simulation waits at its start or after a jump for a node that can answer. It
  /// is observed later; until then, this shows it.
  virtual void show(const Simulation& simulation) = 0;
  /// Called if no node has connected for seconds. Nodes that wait for odometry may get one message,
  /// which needs no answer.
  virtual void remind(const Simulation& simulation) = 0;
  /// Sends the last observation again.
  virtual void repeat(const Simulation& simulation) = 0;
  virtual void warn(const std::string& what) = 0;
  /// Whether a node is connected that can send commands.
  virtual bool has_commander() const = 0;
};

/// Counts and state of a flight.
struct FlightReport {
  double time = 0;              ///< simulation time [s]
  double real_time_factor = 0;  ///< requested factor; 0 = no limit, or another node sets the pace
  std::int64_t steps = 0;
  std::int64_t commands = 0;         ///< accepted
  std::size_t waiting_commands = 0;  ///< accepted, in lockstep, for future messages
  std::int64_t late_commands = 0;    ///< in lockstep unanswered messages; else gaps in the commands
  std::int64_t overruns = 0;         ///< steps that began more than one period late
  bool paused = false;
  bool commands_stopped = false;   ///< the controller has sent none for the timeout
  bool waits_for_clock = false;    ///< of another node that has not published it
  bool waits_for_command = false;  ///< in lockstep, for the first since the start or the last jump
  std::string failure;             ///< reason of the end; "" during the flight
};

/// Runs a simulation in its own thread. Every public member may be called from any thread. Only the
/// flight's thread accesses the simulation, except that it lends it to a command that it waits for.
class FlightThread {
 public:
  FlightThread(Simulation& simulation, const FlightSettings& settings, FlightListener& listener);
  ~FlightThread();
  FlightThread(const FlightThread&) = delete;
  FlightThread& operator=(const FlightThread&) = delete;

  /// Sets the rotor speeds for the next step and all later ones, in lockstep for those after the
  /// message that they answer. Throws like CommandQueue::take(); the last valid command then
  /// remains.
  void command(const CommandQueue::Command& command);
  /// Pauses or resumes. A flight that follows a clock resumes at the clock's time.
  void set_paused(bool paused);
  void set_real_time_factor(double factor);
  /// Sets the time of the followed clock.
  void clock(double time);
  /// Lets no step begin after this time, for a leader of the clock.
  void hold(double time);
  /// Pauses, makes n steps and returns after the last is observed. Throws InputError if it is
  /// interrupted, if another call steps, or if the flight follows a clock. Throws FlightError if
  /// the flight fails.
  void step(std::int64_t n);
  /// Runs `change` between two steps; it must not change the motion. Rethrows its exceptions.
  void run_between_steps(const std::function<void(Simulation&)>& change);
  /// Runs `change` between two steps and returns after the result is observed. Rethrows its
  /// exceptions.
  void change(const std::function<void(Simulation&)>& change);
  /// Does the same, and discards waiting commands.
  void reset(const std::function<void(Simulation&)>& change);
  FlightReport report() const;
  /// Ends the flight; callers that wait for a step or a change get an error. Only the owner calls
  /// it.
  void end();

 private:
  using Lock = std::unique_lock<std::mutex>;

  // In flight_loop.cpp: the flight's thread.
  void run();
  bool wait_until_due();
  void wait_for_pace(Lock& lock);
  void join_clock(Lock& lock);
  std::string describe_clock_jump(double time) const;
  void wait_for_commander(Lock& lock);
  void wait_for_command(Lock& lock);
  void observe_jump();
  void run_changes(Lock& lock);
  bool may_step_with_command() const;
  void step_with_command(Lock& lock);
  void take_step();
  std::string try_step();
  void fail(const std::string& why);
  template <class Action>
  void unlocked(Lock& lock, const Action& action);
  template <class Condition>
  bool wait(Lock& lock, std::chrono::duration<double> patience, const Condition& condition);

  void run_in_flight(const std::function<void()>& action);
  void jump(const std::function<void(Simulation&)>& change, bool forget_commands);
  bool may_step() const { return failure_.empty() && (!paused_ || steps_allowed_ > 0); }
  /// Number of messages so far that need a command.
  double count_odometry() const;
  bool is_interrupted() const { return ending_ || !changes_.empty() || !may_step(); }

  Simulation& simulation_;
  const FlightSettings settings_;
  FlightListener& listener_;
  const int answered_;  ///< topic, or -1

  mutable std::mutex mutex_;  // guards the following members
  std::condition_variable changed_;
  bool ending_ = false;
  bool paused_;
  std::int64_t steps_allowed_ = 0;  ///< by step(), during a pause
  std::deque<std::packaged_task<void()>> changes_;
  CommandQueue commands_;
  CommandWatch command_watch_;
  /// Whether the flight's thread waits for a command, which may make the next steps.
  bool lends_ = false;
  bool is_lent_ = false;        ///< a command makes steps
  bool jump_observed_ = false;  ///< the last start or jump has been observed
  /// Time at which a commanding node was last connected, or of the last reminder.
  std::optional<Pacer::Clock::time_point> reminded_;
  std::optional<double> clock_;  ///< time of the followed clock [s]
  bool joined_ = false;          ///< the simulation follows clock_
  double hold_ = std::numeric_limits<double>::infinity();
  double real_time_factor_;
  Pacer pacer_;
  FlightReport report_;
  std::string failure_;

  std::mutex stepping_;  ///< one step() at a time
  std::thread thread_;
};

}  // namespace quadcore::node
