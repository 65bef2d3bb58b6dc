#pragma once

#include <pthread.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>
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
    std::thread([signals, came = came_] {
      int signal = 0;
      sigwait(&signals, &signal);
      *came = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(800));
      std::_Exit(0);
    }).detach();
  }

  bool has_come() const { return *came_; }

 private:
  std::shared_ptr<std::atomic<bool>> came_ = std::make_shared<std::atomic<bool>>(false);
};

}  // namespace quadcore::node
