#pragma once

#include <cmath>

#include "quadcore/plugin/elementary.hpp"

namespace quadcore::control {

/// Memory of a low-pass filter.
struct LowPassMemory {
  double before, last;  ///< states of the direct form II
};

/// A Butterworth low-pass filter of second order, by the bilinear transform.
class LowPass {
 public:
  /// \param cutoff  frequency [Hz], below half the sampling rate, else the filter passes everything
  /// \param period  [s]
  LowPass(double cutoff, double period) : passes_(cutoff * period >= 0.5) {
    const elementary::SineCosine half = elementary::sincos(M_PI * cutoff * period);
    const double k = half.sin / half.cos;
    const double scale = 1 + M_SQRT2 * k + k * k;
    gain_ = k * k / scale;
    a1_ = 2 * (k * k - 1) / scale;
    a2_ = (1 - M_SQRT2 * k + k * k) / scale;
  }

  double apply(double sample, LowPassMemory& memory) const {
    if (passes_) return sample;
    const double state = sample - a1_ * memory.last - a2_ * memory.before;
    const double filtered = gain_ * (state + 2 * memory.last + memory.before);
    memory = {memory.last, state};
    return filtered;
  }

 private:
  bool passes_;
  double gain_, a1_, a2_;
};

}  // namespace quadcore::control
