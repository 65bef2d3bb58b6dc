#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "answers.hpp"
#include "pacer.hpp"
#include "quadcore/simulation.hpp"

namespace quadcore::node {

struct FlightSettings {
  double real_time_factor = 1;  ///< simulated seconds per second; 0 = as fast as possible
  bool paused = false;          ///< at the start
  bool lockstep = false;        ///< wait for one command per odometry message
  double lockstep_timeout = 1;  ///< s; a command later than this is done without
};

/// Follows a flight. All calls come from the flight's own thread.
class FlightListener {
 public:
  virtual ~FlightListener() = default;
  /// The simulation has made a step or, `jumped`, was reset or given a state.
  virtual void observe(const Simulation& simulation, bool jumped) = 0;
  /// What was observed last is to be sent once more.
  virtual void repeat(const Simulation& simulation) = 0;
  virtual void warn(const std::string& what) = 0;
  /// Whether anyone is there to send commands.
  virtual bool has_commander() const = 0;
};

/// What has happened so far.
struct FlightReport {
  double time = 0;  ///< of the simulation [s]
  std::int64_t steps = 0;
  std::int64_t commands = 0;       ///< accepted
  std::int64_t late_commands = 0;  ///< odometry messages not answered before the next one
  std::int64_t overruns = 0;       ///< steps that began more than one period late
  bool paused = false;
  bool waiting = false;  ///< in lockstep, for the first command since the start or the last jump
  std::string failure;   ///< why the flight has ended; "" while it goes on
};

/// Flies a simulation in a thread of its own. Every public member may be called from any thread;
/// only the flight's own thread touches the simulation.
class FlightThread {
 public:
  FlightThread(Simulation& simulation, const FlightSettings& settings, FlightListener& listener);
  ~FlightThread();
  FlightThread(const FlightThread&) = delete;
  FlightThread& operator=(const FlightThread&) = delete;

  /// Rotor speeds for the next step and all later ones. Throws InputError on a wrong count or a
  /// number that is not finite; the last good command stays.
  void command(const std::vector<double>& speeds);
  void set_paused(bool paused);
  /// Pauses, flies n steps and returns once the last is observed. Throws InputError if stopped
  /// short or while another call steps, FlightError if the flight fails.
  void step(std::int64_t n);
  /// Runs `change` between two steps and returns once the result is observed. Rethrows what it
  /// throws.
  void change(const std::function<void(Simulation&)>& change);
  /// The same; besides, a command that has not been flown yet is forgotten.
  void reset(const std::function<void(Simulation&)>& change);
  FlightReport report() const;
  /// Ends the flight; callers that still wait for a step or a change are told so. To be called by
  /// the owner alone.
  void end();

 private:
  using Lock = std::unique_lock<std::mutex>;

  void fly();
  bool wait_until_due();
  template <class Condition>
  bool wait(Lock& lock, std::chrono::duration<double> patience, const Condition& condition);
  void wait_for_commander(Lock& lock);
  void wait_for_command(Lock& lock);
  void repeat_message(Lock& lock);
  void run(const std::function<void(Simulation&)>& change, bool forget_command);
  void observe_jump();
  void run_changes(Lock& lock);
  void take_step();
  bool may_step() const { return failure_.empty() && (!paused_ || steps_allowed_ > 0); }
  bool disturbed() const { return ending_ || !changes_.empty() || !may_step(); }
  bool waits_to_begin() const { return settings_.lockstep && !commanded_ && may_step(); }

  Simulation& simulation_;
  const FlightSettings settings_;
  FlightListener& listener_;
  const std::size_t command_width_;
  const int odometry_topic_;

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  bool ending_ = false;
  bool paused_;
  std::int64_t steps_allowed_ = 0;  ///< by step(), while paused
  std::deque<std::packaged_task<void()>> changes_;
  std::vector<double> command_;
  bool commanded_ = false;      ///< a command has come since the start or the last jump
  bool command_waits_ = false;  ///< command_ has not been flown yet
  Answers answers_;
  bool jump_observed_ = false;  ///< the present start or jump has been observed
  FlightReport report_;
  std::string failure_;

  std::mutex stepping_;  ///< one step() at a time
  Pacer pacer_;          ///< the flight thread's own
  std::thread thread_;
};

}  // namespace quadcore::node
