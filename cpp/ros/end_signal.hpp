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
/// after the signal, because a master or a name server hangs, is ended here: well if the flight's
/// log was closed by then, with status 2 if not.
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
      std::this_thread::sleep_for(std::chrono::milliseconds(800));
      if (!state->flight_is_kept) {
        std::fputs("error: the flight could not be ended in time; its log may be cut short\n",
                   stderr);
        std::_Exit(2);
      }
      std::_Exit(0);
    }).detach();
  }

  bool has_come() const { return state_->came; }
  /// What a flight leaves behind is written.
  void flight_is_kept() const { state_->flight_is_kept = true; }

 private:
  struct State {
    std::atomic<bool> came{false};
    std::atomic<bool> flight_is_kept{false};
  };
  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace quadcore::node
