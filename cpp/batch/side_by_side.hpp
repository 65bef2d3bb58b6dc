#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <exception>
#include <future>
#include <thread>
#include <vector>

namespace quadcore {

/// Call work(begin, end) for parts of 0 ... count in separate threads and wait for all. Rethrows
/// the exception of the first part that threw one.
/// \param threads  maximum number; 0: one for each processor
/// \param poll  called by this thread at times while it waits for the others; an exception counts
/// as
///              one of the first part
template <class Work, class Poll>
void side_by_side(unsigned threads, std::size_t count, const Work& work, const Poll& poll) {
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t parts = std::min<std::size_t>(threads, count);
  if (parts <= 1) return work(std::size_t{0}, count);
  std::vector<std::exception_ptr> errors(parts);
  const auto fly = [&](std::size_t part) {
    try {
      work(part * count / parts, (part + 1) * count / parts);
    } catch (...) {
      errors[part] = std::current_exception();
    }
  };
  std::vector<std::future<void>> others;
  std::size_t begun = 1;
  try {
    for (; begun < parts; ++begun) others.push_back(std::async(std::launch::async, fly, begun));
  } catch (const std::exception&) {  // no more threads available: this thread does the rest
  }
  fly(0);
  for (; begun < parts; ++begun) fly(begun);
  for (const std::future<void>& other : others) {
    while (other.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) {
      try {
        poll();
      } catch (...) {
        if (!errors[0]) errors[0] = std::current_exception();
      }
    }
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace quadcore
