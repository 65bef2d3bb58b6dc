#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

#include "hostile_text.hpp"
#include "xml_mutator.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

std::string as_text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  check_hostile_text(as_text(data, size));
  return 0;
}

/// Mostly along the grammar; every eighth time byte by byte, as libFuzzer does.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  const std::string text = as_text(data, size);
  const std::string next = seed % 8 == 0 ? text : XmlMutator(seed).mutated(text);
  if (next == text || next.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, next.data(), next.size());
  return next.size();
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* data, std::size_t size,
                                                 const std::uint8_t* other, std::size_t other_size,
                                                 std::uint8_t* out, std::size_t max_size,
                                                 unsigned int seed) {
  const std::string next =
      XmlMutator(seed).crossed(as_text(data, size), as_text(other, other_size));
  const std::size_t length = std::min(next.size(), max_size);
  std::memcpy(out, next.data(), length);
  return length;
}
