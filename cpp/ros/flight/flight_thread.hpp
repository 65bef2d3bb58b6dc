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
#include "odometry_topic.hpp"
#include "pacer.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::node {

struct FlightSettings {
  double real_time_factor = 1;  ///< simulated seconds per second; 0 = as fast as possible
  bool follows_clock = false;   ///< steps are due by clock() instead
  bool paused = false;          ///< at the start
  bool lockstep = false;        ///< wait for one command per odometry message
  double lockstep_timeout = 1;  ///< s; a command later than this is done without
  std::string answered = OdometryTopic::name;  ///< topic of the simulation that commands answer
};

/// Follows a flight. All calls come from the flight's own thread, which holds no lock then.
class FlightListener {
 public:
  virtual ~FlightListener() = default;
  /// A step is about to begin: what has come for the plugins may be published.
  virtual void feed(Simulation& simulation) = 0;
  /// The simulation has made a step or, `jumped`, was reset or given a state.
  virtual void observe(const Simulation& simulation, bool jumped) = 0;
  /// The simulation waits at its start or at a jump for someone who can answer; it will be observed
  /// then. Until then it may be looked at.
  virtual void show(const Simulation& simulation) = 0;
  /// For seconds nobody has come who can answer. Nodes that wait for odometry may be given one
  /// message, which counts as none that a command answers.
  virtual void remind(const Simulation& simulation) = 0;
  /// What was observed last is to be sent once more.
  virtual void repeat(const Simulation& simulation) = 0;
  virtual void warn(const std::string& what) = 0;
  /// Whether anyone is there to send commands.
  virtual bool has_commander() const = 0;
};

/// What has happened so far.
struct FlightReport {
  double time = 0;              ///< of the simulation [s]
  double real_time_factor = 0;  ///< asked for; 0 = none: no limit, or others set the pace
  std::int64_t steps = 0;
  std::int64_t commands = 0;         ///< accepted
  std::size_t waiting_commands = 0;  ///< accepted, in lockstep, for messages to come
  std::int64_t late_commands = 0;    ///< odometry messages not answered before the next one
  std::int64_t overruns = 0;         ///< steps that began more than one period late
  bool paused = false;
  bool waits_for_clock = false;    ///< of somebody else, who has sent none yet
  bool waits_for_command = false;  ///< in lockstep, the first since the start or the last jump
  std::string failure;             ///< why the flight has ended; "" while it goes on
};

/// Flies a simulation in a thread of its own. Every public member may be called from any thread;
/// only the flight's own thread touches the simulation.
class FlightThread {
 public:
  FlightThread(Simulation& simulation, const FlightSettings& settings, FlightListener& listener);
  ~FlightThread();
  FlightThread(const FlightThread&) = delete;
  FlightThread& operator=(const FlightThread&) = delete;

  /// Rotor speeds for the next step and all later ones, in lockstep for those after the message
  /// they answer. Throws what CommandQueue::take() throws; the last good command stays.
  void command(const CommandQueue::Command& command);
  /// Of a flight that follows the clock: its vehicle stands still, and goes on at the clock's time.
  void set_paused(bool paused);
  void set_real_time_factor(double factor);
  /// The clock that is followed has come to this time.
  void clock(double time);
  /// No step may begin later than this; for one who leads the clock of others.
  void hold(double time);
  /// Pauses, flies n steps and returns once the last is observed. Throws InputError if stopped
  /// short, while another call steps or if the flight follows a clock, FlightError if it fails.
  void step(std::int64_t n);
  /// Runs `change` between two steps; it leaves the motion as it is. Rethrows what it throws.
  void tell(const std::function<void(Simulation&)>& change);
  /// Runs `change` between two steps and returns once the result is observed. Rethrows what it
  /// throws.
  void change(const std::function<void(Simulation&)>& change);
  /// The same; besides, commands that have not been flown yet are forgotten.
  void reset(const std::function<void(Simulation&)>& change);
  FlightReport report() const;
  /// Ends the flight; callers that still wait for a step or a change are told so. To be called by
  /// the owner alone.
  void end();

 private:
  using Lock = std::unique_lock<std::mutex>;

  // In flight_loop.cpp: the flight's own thread.
  void fly();
  bool wait_until_due();
  void wait_for_pace(Lock& lock);
  void join_clock(Lock& lock);
  void wait_for_commander(Lock& lock);
  void wait_for_command(Lock& lock);
  void observe_jump();
  void run_changes(Lock& lock);
  void take_step();
  std::string try_step();
  void fail(const std::string& why);
  template <class Action>
  void unlocked(Lock& lock, const Action& action);
  template <class Condition>
  bool wait(Lock& lock, std::chrono::duration<double> patience, const Condition& condition);

  void between_steps(const std::function<void()>& action);
  void jump(const std::function<void(Simulation&)>& change, bool forget_commands);
  bool may_step() const { return failure_.empty() && (!paused_ || steps_allowed_ > 0); }
  /// Messages so far that a command is to answer.
  double asked() const;
  bool disturbed() const { return ending_ || !changes_.empty() || !may_step(); }

  Simulation& simulation_;
  const FlightSettings settings_;
  FlightListener& listener_;
  const int answered_;  ///< topic, or -1

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  bool ending_ = false;
  bool paused_;
  std::int64_t steps_allowed_ = 0;  ///< by step(), while paused
  std::deque<std::packaged_task<void()>> changes_;
  CommandQueue commands_;
  bool jump_observed_ = false;  ///< the present start or jump has been observed
  /// When somebody who can answer was last seen, or others were last reminded that nobody is there.
  std::optional<Pacer::Clock::time_point> reminded_;
  std::optional<double> clock_;  ///< of somebody else [s]
  bool joined_ = false;          ///< the simulation goes by clock_
  double hold_ = std::numeric_limits<double>::infinity();
  double real_time_factor_;
  Pacer pacer_;
  FlightReport report_;
  std::string failure_;

  std::mutex stepping_;  ///< one step() at a time
  std::thread thread_;
};

}  // namespace quadcore::node
