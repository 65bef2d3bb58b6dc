#pragma once

#include <pthread.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>

namespace quadcore::node {

/// Waits for SIGINT, SIGTERM and SIGHUP. Construct it before any other thread starts, so that all
/// threads block these signals. After a signal, the process has most of a second to end by itself.
/// If a hanging master or name server prevents this after the end of the flight, this thread ends
/// the process with the flight's status. If a step does not return, for example because a pipe of
/// the log is not read, it ends the process with status 2. It waits for a log that is being
/// written, until a second signal.
class EndSignal {
 public:
  EndSignal() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread([signals, state = state_] {
      int signal = 0;
      sigwait(&signals, &signal);
      state->came = true;
      auto begun = Clock::now();
      while (state->status == kFlying && Clock::now() - begun < longest_step) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
      if (state->status == kFlying) {
        give_up("The flight did not end in time. Its log may be incomplete.");
      }
      const timespec moment{0, 10'000'000};
      while (state->status == kWriting) {
        if (sigtimedwait(&signals, nullptr, &moment) >= 0) {
          give_up("A second signal came while the log was written. The log is lost.");
        }
        begun = Clock::now();
      }
      std::this_thread::sleep_until(begun + patience);
      std::_Exit(state->status);
    }).detach();
  }

  bool has_come() const { return state_->came; }
  /// Call after the last step.
  void flight_is_being_written() const { state_->status = kWriting; }
  /// Call after all output is written and errors are reported.
  void flight_ended_with(int status) const { state_->status = status; }

 private:
  static constexpr int kFlying = -1;
  static constexpr int kWriting = -2;
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds patience{800};
  static constexpr std::chrono::seconds longest_step{10};  // roslaunch kills after 15 s
  struct State {
    std::atomic<bool> came{false};
    std::atomic<int> status{kFlying};  // exit status
  };

  [[noreturn]] static void give_up(const char* why) {
    std::fprintf(stderr, "error: %s\n", why);
    std::_Exit(2);
  }

  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace quadcore::node
