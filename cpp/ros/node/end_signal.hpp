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

/// Waits for SIGINT, SIGTERM and SIGHUP. Make one before any other thread starts, so that all of
/// them leave these signals alone. A process whose flight has ended, but which has not ended by
/// itself within most of a second after the signal, because a master or a name server hangs, is
/// ended here with the flight's status. A flight whose step does not return, because nobody reads
/// the pipe that its log goes to, is ended with status 2; a busy machine is no reason for that. A
/// log that is being written is waited for, until a second signal.
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
        give_up("the flight could not be ended in time; its log may be cut short");
      }
      const timespec moment{0, 10'000'000};
      while (state->status == kWriting) {
        if (sigtimedwait(&signals, nullptr, &moment) >= 0) {
          give_up("ended again while the log was being written, which is lost");
        }
        begun = Clock::now();
      }
      std::this_thread::sleep_until(begun + patience);
      std::_Exit(state->status);
    }).detach();
  }

  bool has_come() const { return state_->came; }
  /// No step follows.
  void flight_is_being_written() const { state_->status = kWriting; }
  /// What a flight leaves behind is written as far as it could be, and what is wrong was said.
  void flight_ended_with(int status) const { state_->status = status; }

 private:
  static constexpr int kFlying = -1;
  static constexpr int kWriting = -2;
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds patience{800};
  static constexpr std::chrono::seconds longest_step{10};  // roslaunch kills after 15 s
  struct State {
    std::atomic<bool> came{false};
    std::atomic<int> status{kFlying};  // with which to exit
  };

  [[noreturn]] static void give_up(const char* why) {
    std::fprintf(stderr, "error: %s\n", why);
    std::_Exit(2);
  }

  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace quadcore::node
