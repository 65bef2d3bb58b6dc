#pragma once

#include "angles.hpp"
#include "lanes/turn.hpp"
#include "rotor_forces.hpp"

namespace quadcore::laws {

/// The motion provided by an engine: its tables and the frame's numbers.
struct ShownMotion {
  RotorLanes rotors;
  const double* frame;  ///< FrameNumber
};

/// The motion of a pack of rotors starting at rotor i, see laws/rotor_forces.hpp.
template <class T>
struct ShownPack {
  const ShownMotion& shown;
  std::size_t i;

  QUADCORE_LAW T rate() const { return load<T>(row(MotionRow::rate)); }
  QUADCORE_LAW Vec3<T> axis_F() const { return vector(MotionRow::axis); }
  QUADCORE_LAW Vec3<T> normal_F() const { return vector(MotionRow::normal); }
  QUADCORE_LAW Vec3<T> velocity_F(bool of_origins) const {
    return vector(of_origins ? MotionRow::v_WR : MotionRow::v_WRcm);
  }
  QUADCORE_LAW Vec3<T> in_frame(const Vec3<T>& f_R) const {
    if (shown.rotors.has_rotations) return columns(MotionRow::R_FR) * f_R;
    return turned(axis_F(), sine_and_cosine(load<T>(row(MotionRow::angle))),
                  columns(MotionRow::R_FR_at_zero) * f_R);
  }
  QUADCORE_LAW bool windy() const { return true; }
  QUADCORE_LAW Vec3<T> v_WA_F() const { return of_frame(FrameNumber::v_WA_F); }
  QUADCORE_LAW Vec3<T> w_WF_F() const { return of_frame(FrameNumber::w_WF_F); }
  QUADCORE_LAW Vec3<T> v_WF_W() const {
    return broadcast<T>(matrix(shown.frame + FrameNumber::R_WF) *
                        vec(shown.frame + FrameNumber::v_WF_F));
  }

 private:
  QUADCORE_LAW const double* row(std::size_t row) const {
    return shown.rotors.motion + rotor_offset(MotionRow::count, i) + row * widest_lanes;
  }
  QUADCORE_LAW Vec3<T> vector(std::size_t at) const { return load3<T>(row(at)); }
  QUADCORE_LAW Matrix3<T> columns(std::size_t at) const {
    const Vec3<T> x = vector(at), y = vector(at + 3), z = vector(at + 6);
    return {x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z};
  }
  QUADCORE_LAW Vec3<T> of_frame(std::size_t number) const {
    return broadcast<T>(shown.frame + number);
  }
};

/// Add the forces and reactions of a law to a pack of rotors, starting at rotor i.
template <class T>
QUADCORE_LAW void add_rotor_forces(const RotorForces& law, const ShownMotion& shown, std::size_t i,
                                   RotorLoads<T>& loads) {
  add_rotor_forces(laws_of_rotors<T>(law, i), ShownPack<T>{shown, i}, loads);
}

}  // namespace quadcore::laws
