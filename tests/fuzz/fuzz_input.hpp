#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

/// Reads choices and numbers from the bytes of a fuzzer; behind their end all are 0.
class FuzzInput {
 public:
  FuzzInput(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}

  /// A number of 16 bits below n.
  std::size_t below(std::size_t n) { return take<std::uint16_t>() % n; }
  template <class T>
  const T& any(const std::vector<T>& items) {
    return items[below(items.size())];
  }
  template <class T>
  T take() {
    T value{};
    const std::size_t size = std::min(sizeof(T), static_cast<std::size_t>(end_ - at_));
    std::memcpy(&value, at_, size);
    at_ += size;
    return value;
  }
  /// So many bytes at most.
  std::string text(std::size_t longest) {
    const std::size_t size = std::min(longest, static_cast<std::size_t>(end_ - at_));
    const std::string text(reinterpret_cast<const char*>(at_), size);
    at_ += size;
    return text;
  }

 private:
  const std::uint8_t* at_;
  const std::uint8_t* end_;
};
