#pragma once

#include <cmath>
#include <cstdint>

#include "quadcore/plugin/counts.hpp"
#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/spatial.hpp"

namespace quadcore::rotors {

/// Random numbers of a program that never seeds its generator: those of GCC's
/// std::default_random_engine (Lewis, Goodman, Miller, 1969: x' = 16807 x mod 2^31 - 1, starting at
/// 1) and its std::normal_distribution (Marsaglia's polar method, two numbers at a time). The C++
/// standard does not define the latter; this implementation is identical everywhere.
class StandardRandom {
 public:
  enum Memory { kBegun, kEngine, kHasSpare, kSpare, kMemorySize };

  explicit StandardRandom(Eigen::Ref<VectorXd> memory) : memory_(memory) {
    if (memory_[kBegun] != 0) return;
    memory_[kBegun] = memory_[kEngine] = 1;
  }

  /// Return a normal number with mean 0 and standard deviation 1.
  double normal() {
    if (memory_[kHasSpare] != 0) {
      memory_[kHasSpare] = 0;
      return memory_[kSpare];
    }
    double x, y, square;
    do {
      x = 2 * uniform() - 1;
      y = 2 * uniform() - 1;
      square = x * x + y * y;
    } while (square > 1 || square == 0);
    const double factor = std::sqrt(-2 * elementary::log(square) / square);
    memory_[kHasSpare] = 1;
    memory_[kSpare] = x * factor;
    return y * factor;
  }

 private:
  /// Return one of 2^31 - 2 numbers, starting at 0.
  double next() {
    constexpr std::uint64_t modulus = 2147483647;
    // Minus 1, because the generator never returns 0.
    const std::uint64_t engine = 1 + count_of(memory_[kEngine] - 1, modulus - 2);
    memory_[kEngine] = static_cast<double>(16807 * engine % modulus);
    return memory_[kEngine] - 1;
  }
  /// Return a number in [0, 1) with the precision of a double, from two numbers of the engine.
  double uniform() {
    constexpr double range = 2147483646.0;
    const double low = next(), high = next();
    const double number = (low + high * range) / (range * range);
    return number < 1 ? number : std::nextafter(1.0, 0.0);
  }

  Eigen::Ref<VectorXd> memory_;
};

}  // namespace quadcore::rotors
