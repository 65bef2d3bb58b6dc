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

}  // namespace

int lane_width() {
  static const int most = widest();
  const char* const text = std::getenv("QUADCORE_LANES");
  if (!text) return most;
  for (const int width : {1, 2, 4, 8}) {
    if (text == std::to_string(width)) return std::min(width, most);
  }
  throw InputError("QUADCORE_LANES is '" + std::string(text) + "'. Use 1, 2, 4 or 8.");
}

}  // namespace quadcore
