#pragma once

namespace quadcore::elementary {

/// x = quadrant pi/2 + y + tail, but for whole turns: |y| <= pi/4, quadrant 0 to 3, the sum y +
/// tail good to 2^-70 or better, relatively.
struct Reduced {
  double y, tail;
  int quadrant;
};

/// Takes any x; one that is not finite gives NaN.
Reduced reduced(double x);

}  // namespace quadcore::elementary
