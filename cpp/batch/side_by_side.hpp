#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace quadcore {

/// Call work(begin, end) for parts of 0 ... count in separate threads and wait for all. Rethrows
/// the exception of the first part that threw one.
/// \param threads  maximum number; 0: one for each processor
template <class Work>
void side_by_side(unsigned threads, std::size_t count, const Work& work) {
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
  std::vector<std::thread> others;
  std::size_t begun = 1;
  try {
    others.reserve(parts - 1);
    for (; begun < parts; ++begun) others.emplace_back(fly, begun);
  } catch (const std::exception&) {  // no more threads available: this thread does the rest
  }
  fly(0);
  for (; begun < parts; ++begun) fly(begun);
  for (std::thread& other : others) other.join();
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace quadcore
