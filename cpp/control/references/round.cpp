#include "quadcore/plugin/elementary.hpp"
#include "references/shapes.hpp"

namespace quadcore::control {
namespace {

using T = TagSpec;

/// Add amplitude sin(rate t + phase) along an axis. A phase of a quarter turn makes it a cosine.
/// \param angle  sine and cosine of rate t
void add_wave(Reference& wanted, int axis, double amplitude, double rate,
              const elementary::SineCosine& angle, bool cosine) {
  const auto [s, c] = angle;
  const double wave = amplitude * (cosine ? c : s), slope = amplitude * (cosine ? -s : c);
  wanted.position[axis] += wave;
  wanted.velocity[axis] += rate * slope;
  wanted.acceleration[axis] -= rate * rate * wave;
  wanted.jerk[axis] -= rate * rate * rate * slope;
  wanted.snap[axis] += rate * rate * rate * rate * wave;
}

/// x = r cos(rate t), y = r sin(rate t), z = climb t from the centre, thesis eq. (6.1).
struct Spiral : ReferenceShape, Place {
  double radius, rate, climb;

  Reference at(double t) const override {
    Reference wanted;
    wanted.position = position();
    const elementary::SineCosine angle = elementary::sincos(rate * t);
    add_wave(wanted, 0, radius, rate, angle, true);
    add_wave(wanted, 1, radius, rate, angle, false);
    wanted.position.z() += climb * t;
    wanted.velocity.z() = climb;
    turn(t, wanted);
    return wanted;
  }
};

/// x = length sin(rate t), y = width sin(2 rate t) from the centre.
struct Eight : ReferenceShape, Place {
  double length, width, rate;

  Reference at(double t) const override {
    Reference wanted;
    wanted.position = position();
    add_wave(wanted, 0, length, rate, elementary::sincos(rate * t), false);
    add_wave(wanted, 1, width, 2 * rate, elementary::sincos(2 * rate * t), false);
    turn(t, wanted);
    return wanted;
  }
};

Settings<Spiral> spiral_settings() {
  return with_place<Spiral>({
      {T::number("radius", "m", "2", "radius of the circle").at_least(0).from("(6.1)"),
       &Spiral::radius},
      {T::number("rate", "rad/s", "0.5", "angular rate; negative: clockwise").from("(6.1)"),
       &Spiral::rate},
      {T::number("climb", "m/s", "1", "vertical velocity").from("(6.1)"), &Spiral::climb},
  });
}

}  // namespace

ReferenceInfo spiral() {
  return shape<Spiral>("spiral", "rising circle, thesis (6.1)", spiral_settings());
}

ReferenceInfo circle() {
  return shape<Spiral>("circle", "level circle", spiral_settings(), {{"rate", 1.5}, {"climb", 0}});
}

ReferenceInfo eight() {
  return shape<Eight>(
      "eight", "level figure of eight",
      with_place<Eight>({
          {T::number("length", "m", "2", "half of the length, along x"), &Eight::length},
          {T::number("width", "m", "1", "half of the width, along y"), &Eight::width},
          {T::number("rate", "rad/s", "1.2",
                     "angular frequency of the slower oscillation, along x"),
           &Eight::rate},
      }));
}

}  // namespace quadcore::control
