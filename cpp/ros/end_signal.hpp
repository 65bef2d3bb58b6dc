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
/// them leave these signals alone. A process that has not ended by itself within most of a second
/// after the signal, because a master or a name server hangs, is ended here: with the flight's
/// status if its log was closed by then, with status 2 if not. A log that is being written is
/// waited for, until a second signal.
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
      std::this_thread::sleep_for(patience);
      if (state->status == kFlying) {
        give_up("the flight could not be ended in time; its log may be cut short");
      }
      if (state->status == kWriting) {
        const timespec moment{0, 10'000'000};
        while (state->status == kWriting) {
          if (sigtimedwait(&signals, nullptr, &moment) < 0) continue;
          give_up("ended again while the log was being written, which is lost");
        }
        std::this_thread::sleep_for(patience);
      }
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
  static constexpr std::chrono::milliseconds patience{800};
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
