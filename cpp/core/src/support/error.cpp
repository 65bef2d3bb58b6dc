#include "quadcore/plugin/error.hpp"

#include "quadcore/text.hpp"

namespace quadcore {
namespace {

constexpr std::size_t longest_message = 1000;
constexpr std::size_t head = 700;
constexpr std::size_t tail = 250;

bool starts_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }

/// C0, delete and C1 control characters, which would disturb a terminal.
bool is_control(const std::string& text, std::size_t at) {
  const auto first = static_cast<unsigned char>(text[at]);
  const bool c1 = first == 0xC2 && static_cast<unsigned char>(text[at + 1]) < 0xA0;
  return first < 0x20 || first == 0x7F || c1;
}

/// Shorten a message that quotes a very long text.
std::string shortened(const std::string& text) {
  if (text.size() <= longest_message) return text;
  std::size_t end = head, begin = text.size() - tail;
  while (!starts_character(text[end])) --end;
  while (!starts_character(text[begin])) ++begin;
  return text.substr(0, end) + " ... " + text.substr(begin);
}

}  // namespace

// Invalid bytes and control characters become '?', line ends and tabs become blanks.
std::string one_line(const std::string& text) {
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = character_size(text, at);
    if (text[at] == '\n' || text[at] == '\t' || text[at] == '\r') {
      line += ' ';
    } else if (size == 0 || is_control(text, at)) {
      line += '?';
    } else {
      line.append(text, at, size);
    }
    at += size ? size : 1;
  }
  return shortened(line);
}

Error::Error(const std::string& what) : std::runtime_error(one_line(what)) {}

std::string what_was_thrown() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "an exception was thrown that is not a std::exception";
  }
}

}  // namespace quadcore
