#include "expectations.hpp"

#include <algorithm>
#include <stdexcept>

namespace {

constexpr std::size_t longest_message = 1000;

}  // namespace

void check_one_line(const std::string& message) {
  const bool one_line = std::none_of(message.begin(), message.end(),
                                     [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (message.empty() || !one_line || message.size() > longest_message) {
    throw std::logic_error("not a message of one line: " + message);
  }
}

void TimeLimit::check() const {
  if (std::clock() - begin_ > CLOCKS_PER_SEC) throw std::logic_error("took longer than 1 s");
}
