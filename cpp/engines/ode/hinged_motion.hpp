#pragma once

#include "hinged_bodies.hpp"

namespace quadcore {

/// Motion of the frames of bodies on hinges, after their geometry has been read.
template <class T>
struct HingedFrame {
  Matrix3<T> R_WF;
  Vec3<T> p_FFcm_F, w_WF_F, v_WFcm_F, v_WF_F, p_WF;

  template <Lanes lanes>
  QUADCORE_LAW explicit HingedFrame(const HingedBodies<T, lanes>& bodies)
      : R_WF(bodies.work(0).R_WB),
        p_FFcm_F(-1.0 * bodies.constants(0).vector(BodyConstant::origin)),
        w_WF_F(laws::inversely(R_WF, bodies.state(0).vector(BodyRow::rate))),
        v_WFcm_F(laws::inversely(R_WF, bodies.state(0).vector(BodyRow::velocity))),
        v_WF_F(v_WFcm_F - laws::cross(w_WF_F, p_FFcm_F)),
        p_WF(bodies.state(0).vector(BodyRow::position) - R_WF * p_FFcm_F) {}
};

/// Motion of the i-th rotors, which are the bodies after the frame; vectors in frame axes.
template <class T, Lanes lanes>
struct HingedRotor {
  const HingedBodies<T, lanes>& bodies;
  const HingedFrame<T>& frame;
  std::size_t i;

  QUADCORE_LAW const Matrix3<T>& R_WR() const { return bodies.work(i + 1).R_WB; }
  QUADCORE_LAW T rate() const { return bodies.joint_rate(i + 1); }
  QUADCORE_LAW Vec3<T> axis_F() const { return in_frame_axes(bodies.work(i + 1).axis_W); }
  QUADCORE_LAW Vec3<T> x_F() const { return in_frame_axes({R_WR().xx, R_WR().yx, R_WR().zx}); }
  QUADCORE_LAW Vec3<T> y_F() const { return in_frame_axes({R_WR().xy, R_WR().yy, R_WR().zy}); }
  QUADCORE_LAW Vec3<T> normal_F() const { return in_frame_axes({R_WR().xz, R_WR().yz, R_WR().zz}); }
  QUADCORE_LAW Vec3<T> p_FRcm_F() const {
    return in_frame_axes(state().vector(BodyRow::position) - frame.p_WF);
  }
  /// Return the velocity of the links' origins or of their centres of mass.
  QUADCORE_LAW Vec3<T> velocity_F(bool of_origins) const {
    const Vec3<T> v_WRcm_W = state().vector(BodyRow::velocity);
    if (!of_origins) return in_frame_axes(v_WRcm_W);
    const Vec3<T> arm_W = R_WR() * bodies.constants(i + 1).vector(BodyConstant::origin);
    return in_frame_axes(v_WRcm_W + laws::cross(state().vector(BodyRow::rate), arm_W));
  }

 private:
  QUADCORE_LAW auto state() const { return bodies.state(i + 1); }
  QUADCORE_LAW Vec3<T> in_frame_axes(const Vec3<T>& a_W) const {
    return laws::inversely(frame.R_WF, a_W);
  }
};

/// Compute the centres of mass of whole vehicles from the origins of their frames, and their
/// velocities.
template <class T>
struct HingedCenter {
  Vec3<T> p_FCcm_F, v_WCcm_F;

  template <Lanes lanes>
  QUADCORE_LAW HingedCenter(const HingedBodies<T, lanes>& bodies, const HingedFrame<T>& frame) {
    T mass = bodies.constants(0).number(BodyConstant::mass);
    Vec3<T> p_F = mass * frame.p_FFcm_F, v_F = mass * frame.v_WFcm_F;
    for (std::size_t i = bodies.size(); i-- > 1;) {
      const HingedRotor<T, lanes> rotor{bodies, frame, i - 1};
      const T of_rotor = bodies.constants(i).number(BodyConstant::mass);
      const Vec3<T> p = of_rotor * rotor.p_FRcm_F(), v = of_rotor * rotor.velocity_F(false);
      bodies.add_to_carrier(i, mass, p_F.x, p_F.y, p_F.z, of_rotor, p.x, p.y, p.z);
      bodies.add_to_carrier(i, v_F.x, v.x);
      bodies.add_to_carrier(i, v_F.y, v.y);
      bodies.add_to_carrier(i, v_F.z, v.z);
    }
    const T by = 1 / mass;
    p_FCcm_F = by * p_F;
    v_WCcm_F = by * v_F;
  }
};

/// Add loads on the frames, with the torque about the origin.
template <class T, Lanes lanes>
QUADCORE_LAW void push_frame(const HingedBodies<T, lanes>& bodies, const HingedFrame<T>& frame,
                             const Vec3<T>& f_F, const Vec3<T>& tau_F) {
  Spatial<T>& force = bodies.work(0).force;
  force.linear = force.linear + frame.R_WF * f_F;
  force.angular = force.angular + frame.R_WF * (tau_F - laws::cross(frame.p_FFcm_F, f_F));
}

/// Add forces on the i-th rotors and the torques of their joints.
template <class T, Lanes lanes>
QUADCORE_LAW void push_rotor(const HingedBodies<T, lanes>& bodies, const HingedFrame<T>& frame,
                             std::size_t i, const Vec3<T>& f_F, T joint_torque, T rate) {
  const T damping = bodies.constants(i + 1).number(BodyConstant::damping);
  BodyWork<T>& rotor = bodies.work(i + 1);
  rotor.force.linear = rotor.force.linear + frame.R_WF * f_F;
  rotor.torque = rotor.torque + (joint_torque - damping * rate);
}

}  // namespace quadcore
