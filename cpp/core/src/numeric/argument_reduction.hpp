#pragma once

namespace quadcore::elementary {

/// x = quadrant pi/2 + y + tail, up to whole turns. |y| <= pi/4, quadrant is 0 to 3, and the
/// relative error of y + tail is at most 2^-70.
struct Reduced {
  double y, tail;
  int quadrant;
};

/// Accepts any x. A value that is not finite gives NaN.
Reduced reduced(double x);

}  // namespace quadcore::elementary
