#pragma once

#include <pthread.h>

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <thread>

namespace quadcore::node {

/// Waits for SIGINT and SIGTERM. Make one before any other thread starts, so that all of them leave
/// these signals alone. A process that has not ended by itself within most of a second after the
/// signal, because a master or a name server hangs, is ended here.
class EndSignal {
 public:
  EndSignal() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread([signals, state = state_] {
      int signal = 0;
      sigwait(&signals, &signal);
      {
        const std::lock_guard<std::mutex> lock(state->mutex);
        state->came = true;
      }
      state->changed.notify_all();
      std::this_thread::sleep_for(std::chrono::milliseconds(800));
      std::_Exit(0);
    }).detach();
  }

  /// Whether the signal has come, after waiting for it no longer than `patience`.
  bool wait_for(std::chrono::milliseconds patience) const {
    std::unique_lock<std::mutex> lock(state_->mutex);
    return state_->changed.wait_for(lock, patience, [this] { return state_->came; });
  }

 private:
  struct State {
    std::mutex mutex;
    std::condition_variable changed;
    bool came = false;
  };
  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace quadcore::node
