#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <thread>

namespace quadcore::batch {

/// A function that may end the work of several threads by throwing. Only the thread that made this
/// object calls it, and waits between calls, because the function may have to wait for an
/// interpreter. The other threads then throw the same.
class SharedPoll {
 public:
  explicit SharedPoll(const std::function<void()>& poll) : poll_(poll) {}

  /// Call this at times in each thread, after some thousand steps.
  void operator()() {
    if (has_thrown_) std::rethrow_exception(thrown_);
    if (std::this_thread::get_id() != caller_ || Clock::now() < next_) return;
    try {
      poll_();
    } catch (...) {
      thrown_ = std::current_exception();
      has_thrown_ = true;
      throw;
    }
    next_ = Clock::now() + std::chrono::milliseconds(20);
  }

 private:
  using Clock = std::chrono::steady_clock;

  const std::function<void()>& poll_;
  const std::thread::id caller_ = std::this_thread::get_id();
  Clock::time_point next_ = Clock::now();  ///< time from which on the function is called
  std::exception_ptr thrown_;              ///< is read after has_thrown_ is set
  std::atomic<bool> has_thrown_{false};
};

}  // namespace quadcore::batch
