#include "references/shapes.hpp"

namespace quadcore::control {
namespace {

using T = TagSpec;

/// A position from `time` on and an offset position before: hover and step.
struct Step : ReferenceShape, Place {
  double dx, dy, dz, dyaw, time;

  Reference at(double t) const override {
    Reference wanted;
    wanted.position = position();
    turn(t, wanted);
    if (t < time) return wanted;
    wanted.position += Vector3d(dx, dy, dz);
    wanted.yaw += dyaw;
    return wanted;
  }
};

struct Hover : ReferenceShape, Place {
  Reference at(double t) const override {
    Reference wanted;
    wanted.position = position();
    turn(t, wanted);
    return wanted;
  }
};

/// At rest until `time`, at a constant velocity from then on.
struct Ramp : ReferenceShape, Place {
  double vx, vy, vz, time;

  Reference at(double t) const override {
    Reference wanted;
    wanted.position = position();
    if (t >= time) {
      wanted.velocity = {vx, vy, vz};
      wanted.position += (t - time) * wanted.velocity;
    }
    turn(t, wanted);
    return wanted;
  }
};

}  // namespace

ReferenceInfo hover() {
  return shape<Hover>("hover", "fixed position", with_place<Hover>({}, false));
}

ReferenceInfo step() {
  return shape<Step>(
      "step", "step from one position to another",
      with_place<Step>(
          {
              {T::number("dx", "m", "1", "step along x"), &Step::dx},
              {T::number("dy", "m", "0", "step along y"), &Step::dy},
              {T::number("dz", "m", "0", "step along z"), &Step::dz},
              {T::number("dyaw", "rad", "0", "step in yaw"), &Step::dyaw},
              {T::number("time", "s", "1", "time of the step").at_least(0), &Step::time},
          },
          false));
}

ReferenceInfo ramp() {
  return shape<Ramp>(
      "ramp", "fixed position, then a constant velocity from one input on",
      with_place<Ramp>({
          {T::number("vx", "m/s", "1", "velocity along x"), &Ramp::vx},
          {T::number("vy", "m/s", "0", "velocity along y"), &Ramp::vy},
          {T::number("vz", "m/s", "0", "velocity along z"), &Ramp::vz},
          {T::number("time", "s", "1", "time at which the motion starts").at_least(0), &Ramp::time},
      }));
}

}  // namespace quadcore::control
