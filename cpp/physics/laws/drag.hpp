#pragma once

#include "rotor_law.hpp"

namespace quadcore::laws {

/// Drag that opposes the rotor's velocity in its own plane, linearly, at the rotor's centre of
/// mass. The plus signs printed in the thesis are an error: drag opposes motion.
template <class T>
struct InPlaneDrag {
  T K;  ///< N s/m

  static constexpr Effect effect = Effect::in_plane_drag;

  template <class Motion>
  QUADCORE_LAW Vec3<T> force(const RotorDisc<T>& disc, const Motion&) const {
    return -K * disc.V_F;
  }
};

/// Induced drag, thesis eq. (2.28).
template <class T>
struct InducedDrag : InPlaneDrag<T> {
  static constexpr const char* term = "induced";
  static constexpr Tag tags[] = {{"inducedDragCoeff", "N s/m", "0", "induced drag of a rotor, K_I",
                                  "(2.28)", Tag::Scales::drag, Tag::at_least_zero, "0.01"}};
  template <class Given>
  static InducedDrag from(const Given& given) {
    const auto [K] = given.numbers(tags);
    return {{given.density_ratio * K}};
  }
};

/// Translational drag, thesis eq. (2.29), without the second branch, as in the thesis.
template <class T>
struct TranslationalDrag : InPlaneDrag<T> {
  static constexpr const char* term = "translational";
  static constexpr Tag tags[] = {{"translationalDragCoeff", "N s/m", "0",
                                  "translational drag of a rotor, K_T1", "(2.29)",
                                  Tag::Scales::drag, Tag::at_least_zero, "0.0025"}};
  template <class Given>
  static TranslationalDrag from(const Given& given) {
    const auto [K] = given.numbers(tags);
    return {{given.density_ratio * K}};
  }
};

/// Profile drag, thesis eq. (2.30).
template <class T>
struct ProfileDrag : InPlaneDrag<T> {
  static constexpr const char* term = "profile";
  static constexpr Tag tags[] = {{"profileDragCoeff", "N s/m", "0", "profile drag of a rotor, K_P",
                                  "(2.30)", Tag::Scales::drag, Tag::at_least_zero, "0.005"}};
  template <class Given>
  static ProfileDrag from(const Given& given) {
    const auto [K] = given.numbers(tags);
    return {{given.density_ratio * K}};
  }
};

/// Return the parasitic drag of the airframe, thesis eq. (2.31): -K |V| V at the vehicle's centre
/// of mass, where V is its velocity relative to the air.
/// \param speed        |V| [m/s]
/// \param coefficient  parasiticDragCoeff [N s^2/m^2]
/// \return     force on the frame in F [N]
template <class Vector, class K>
QUADCORE_LAW Vector parasitic_drag(const Vector& V_F, K speed, K coefficient) {
  return (-coefficient * speed) * V_F;
}

/// Parasitic drag as computed by the thesis' plugin (appendix A.5): -K |v_i| v_i of each component
/// of the frame's WORLD velocity, interpreted in the propeller's own SPINNING axes, once per
/// propeller, at its centre of mass. It is kept because the published results are based on it.
template <class T>
struct ParasiticDrag {
  T K;  ///< N s^2/m^2

  static constexpr const char* term = "parasitic";
  static constexpr Effect effect = Effect::force_in_link_axes;
  static constexpr Tag tags[] = {{"parasiticDragCoeff", "N s^2/m^2", "0",
                                  "parasitic drag of the airframe, K_par", "(2.31)",
                                  Tag::Scales::drag, Tag::at_least_zero, "0.003"}};
  /// Drag of the whole airframe.
  template <class Given>
  static double coefficient(const Given& given) {
    const auto [K] = given.numbers(tags);
    return given.density_ratio * K;
  }
  template <class Given>
  static ParasiticDrag from(const Given& given) {
    return {given.appendix ? coefficient(given) : 0};
  }

  template <class Motion>
  QUADCORE_LAW Vec3<T> force(const RotorDisc<T>&, const Motion& motion) const {
    const Vec3<T> v_WF_W = motion.v_WF_W();
    return -K * Vec3<T>{absolute(v_WF_W.x) * v_WF_W.x, absolute(v_WF_W.y) * v_WF_W.y,
                        absolute(v_WF_W.z) * v_WF_W.z};
  }
};

}  // namespace quadcore::laws
