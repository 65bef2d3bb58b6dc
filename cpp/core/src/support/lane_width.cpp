#include "quadcore/lane_width.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "quadcore/plugin/error.hpp"

namespace quadcore {
namespace {

/// Return the number of doubles in a vector register that processor and system support.
int widest() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq")) {
    return 8;
  }
  if (__builtin_cpu_supports("avx2")) return 4;
#endif
  return 2;
}

/// Return the width that the environment requests, or 0.
int requested_width() {
  const char* text = std::getenv("QUADCORE_LANES");
  if (!text) return 0;
  for (const int width : {1, 2, 4, 8}) {
    if (text == std::to_string(width)) return std::min(width, widest());
  }
  throw InputError("QUADCORE_LANES is '" + std::string(text) + "'. Use 1, 2, 4 or 8.");
}

}  // namespace

RotorCode rotor_code(std::size_t rotors) {
  static const int most = widest();
  if (const int width = requested_width()) return {width, false};
  int width = 2;
  while (width < most && static_cast<std::size_t>(width) < rotors) width *= 2;
  return {width, width == 4 && most == 8};
}

}  // namespace quadcore
