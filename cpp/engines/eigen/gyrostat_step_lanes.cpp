#include "gyrostat_step.hpp"
#include "laws/gyrostat.hpp"
#include "laws/turn.hpp"

namespace quadcore {
namespace {

using laws::Matrix3;
using laws::Vec3;
using At = GyrostatState;

QUADCORE_LAW Vec3<double> vec(const double* a) { return {a[0], a[1], a[2]}; }
QUADCORE_LAW void put(double* to, const Vec3<double>& a) {
  to[0] = a.x;
  to[1] = a.y;
  to[2] = a.z;
}
QUADCORE_LAW Matrix3<double> matrix(const double* columns) {
  const double* m = columns;
  return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]};
}

/// Where a row of rotor i's table in a state lies.
QUADCORE_LAW std::size_t joint(std::size_t row, std::size_t i) {
  return At::joints + rotor_offset(At::joint_rows, i) + row * widest_lanes;
}

/// Sum of a pack's numbers, in their order whatever the width: the padding adds zeros.
template <class T>
QUADCORE_LAW void add_in_order(double& sum, T pack) {
  double numbers[sizeof(T) / sizeof(double)];
  laws::store(numbers, pack);
  for (const double number : numbers) sum += number;
}
template <class T>
QUADCORE_LAW void add_in_order(Vec3<double>& sum, const Vec3<T>& packs) {
  add_in_order(sum.x, packs.x);
  add_in_order(sum.y, packs.y);
  add_in_order(sum.z, packs.z);
}

/// to = a + factor b, for all of a state: the frame's numbers one by one, because they were written
/// so just before, and the rotors' in packs.
template <int W>
QUADCORE_LAW void add_scaled(const GyrostatStep& g, double* to, const double* a, double factor,
                             const double* b) {
  using T = laws::Pack<W>;
  for (std::size_t i = 0; i < At::frame_size; ++i) to[i] = a[i] + factor * b[i];
  for (std::size_t i = 0; i < g.rotors.rotors; i += W) {
    for (std::size_t row = 0; row < At::joint_rows; ++row) {
      const std::size_t at = joint(row, i);
      laws::store(to + at, laws::load<T>(a + at) + factor * laws::load<T>(b + at));
    }
  }
}

template <int W>
QUADCORE_LAW void show(const GyrostatStep& g, const double* state) {
  using T = laws::Pack<W>;
  // Between the stages the quaternion is off unit length, by less than the method's own error.
  const double* q = state + At::orientation;
  const Matrix3<double> R_WF = laws::rotation(q[0], q[1], q[2], q[3]);
  const Vec3<double> w_WF_F = vec(state + At::rate), p_FCcm_F = vec(g.p_FCcm_F);
  const Vec3<double> v_WCcm_F = laws::transposed_times(R_WF, vec(state + At::velocity));
  const Vec3<double> v_WF_F = v_WCcm_F - laws::cross(w_WF_F, p_FCcm_F);
  for (int i = 0; i < 4; ++i) g.q_WF[i] = q[i];
  const double columns[] = {R_WF.xx, R_WF.yx, R_WF.zx, R_WF.xy, R_WF.yy,
                            R_WF.zy, R_WF.xz, R_WF.yz, R_WF.zz};
  for (int i = 0; i < 9; ++i) g.R_WF[i] = columns[i];
  put(g.w_WF_F, w_WF_F);
  put(g.v_WCcm_F, v_WCcm_F);
  put(g.v_WF_F, v_WF_F);
  put(g.p_WF, vec(state + At::position) - R_WF * p_FCcm_F);
  put(g.v_WA_F, laws::transposed_times(R_WF, vec(g.wind_W)));

  const Vec3<T> v = laws::broadcast<T>(v_WF_F), w = laws::broadcast<T>(w_WF_F);
  for (std::size_t i = 0; i < g.rotors.rotors; i += W) {
    const double* constants = g.constants + rotor_offset(RotorConstant::count, i);
    double* motion = g.motion + rotor_offset(MotionRow::count, i);
    const Vec3<T> p_FR_F = laws::load3<T>(constants + RotorConstant::p_FR_F * widest_lanes);
    const Vec3<T> p_FRcm_F = laws::load3<T>(constants + RotorConstant::p_FRcm_F * widest_lanes);
    laws::store3(motion + MotionRow::v_WR * widest_lanes, v + laws::cross(w, p_FR_F));
    laws::store3(motion + MotionRow::v_WRcm * widest_lanes, v + laws::cross(w, p_FRcm_F));
    laws::store(motion + MotionRow::rate * widest_lanes,
                laws::load<T>(state + joint(At::joint_rate, i)));
    const T angle = laws::load<T>(state + joint(At::joint_angle, i));
    laws::store(motion + MotionRow::angle * widest_lanes, angle);
    if (g.normals_turn) {
      const Vec3<T> axis_F = laws::load3<T>(constants + RotorConstant::axis_F * widest_lanes);
      const Vec3<T> z_at_zero_F =
          laws::load3<T>(motion + (MotionRow::R_FR_at_zero + 6) * widest_lanes);
      laws::store3(motion + MotionRow::normal * widest_lanes,
                   laws::turned(axis_F, laws::sine_and_cosine(angle), z_at_zero_F));
    }
  }
}

/// Writes the rate of the state, whose motion is shown.
template <int W>
QUADCORE_LAW void differentiate(const GyrostatStep& g, const double* state, double* to) {
  using T = laws::Pack<W>;
  for (std::size_t i = 0; i < g.rotors.rotors; i += W) {
    double* loads = g.rotors.loads + rotor_offset(LoadRow::count, i);
    for (std::size_t row = 0; row < LoadRow::count; ++row) {
      laws::store(loads + row * widest_lanes, T{});
    }
  }
  g.evaluate(g.engine);

  Vec3<double> f_F{}, tau_F{}, h_F{};
  for (std::size_t i = 0; i < g.rotors.rotors; i += W) {
    const double* constants = g.constants + rotor_offset(RotorConstant::count, i);
    const double* loads = g.rotors.loads + rotor_offset(LoadRow::count, i);
    const T rate = laws::load<T>(state + joint(At::joint_rate, i));
    const T q = laws::load<T>(loads + LoadRow::joint_torque * widest_lanes) -
                laws::load<T>(constants + RotorConstant::damping * widest_lanes) * rate;
    const auto share =
        laws::rotor_share(laws::load3<T>(constants + RotorConstant::axis_F * widest_lanes),
                          laws::load3<T>(constants + RotorConstant::p_FRcm_F * widest_lanes),
                          laws::load<T>(constants + RotorConstant::moment * widest_lanes), rate,
                          laws::load3<T>(loads + LoadRow::force * widest_lanes),
                          laws::load3<T>(loads + LoadRow::reaction * widest_lanes), q);
    add_in_order(f_F, share.f_F);
    add_in_order(tau_F, share.tau_F);
    add_in_order(h_F, share.h_F);
    laws::store(to + joint(At::joint_rate, i),
                q * laws::load<T>(constants + RotorConstant::inverse_moment * widest_lanes));
    laws::store(to + joint(At::joint_angle, i), rate);
  }
  f_F = f_F + vec(g.frame_force_F);
  tau_F = tau_F + vec(g.frame_torque_F) - laws::cross(vec(g.p_FCcm_F), f_F);  // now about C
  // Every load is in one of the two sums.
  const double all = f_F.x + f_F.y + f_F.z + tau_F.x + tau_F.y + tau_F.z;
  if (!(laws::absolute(all) <= 1.7976931348623157e308)) g.refuse(g.engine);

  const Vec3<double> w_WF_F = vec(state + At::rate);
  const Vec3<double> angular_F = laws::angular_acceleration(w_WF_F, tau_F, h_F, matrix(g.I_C_F),
                                                            matrix(g.inverse_reduced_I_F));
  const Vec3<T> angular = laws::broadcast<T>(angular_F);
  for (std::size_t i = 0; i < g.rotors.rotors; i += W) {
    const double* axes =
        g.constants + rotor_offset(RotorConstant::count, i) + RotorConstant::axis_F * widest_lanes;
    double* rate = to + joint(At::joint_rate, i);
    laws::store(rate, laws::load<T>(rate) - laws::dot(laws::load3<T>(axes), angular));
  }
  put(to + At::position, vec(state + At::velocity));
  laws::quaternion_rate(state + At::orientation, w_WF_F, to + At::orientation);
  put(to + At::velocity, g.inverse_mass * (matrix(g.R_WF) * f_F) + vec(g.gravity_W));
  put(to + At::rate, angular_F);
}

template <int W>
QUADCORE_LAW void normalise(const GyrostatStep& g) {
  using T = laws::Pack<W>;
  double* q = g.state + At::orientation;
  const double norm = __builtin_sqrt((q[0] * q[0] + q[1] * q[1]) + (q[2] * q[2] + q[3] * q[3]));
  for (int i = 0; i < 4; ++i) q[i] /= norm;
  for (std::size_t i = 0; i < g.rotors.rotors; i += W) {
    double* angle = g.state + joint(At::joint_angle, i);
    laws::store(angle, laws::within_half_turn(laws::load<T>(angle)));
  }
}

}  // namespace

template <int W>
void show_gyrostat(const GyrostatStep& g, const double* state) {
  show<W>(g, state);
}

template <int W>
void step_gyrostat(const GyrostatStep& g, double dt) {
  differentiate<W>(g, g.state, g.sum);
  const double* rate = g.sum;
  const double reach[] = {dt / 2, dt / 2, dt}, weight[] = {2, 2, 1};
  for (int stage = 0; stage < 3; ++stage) {
    add_scaled<W>(g, g.stage, g.state, reach[stage], rate);
    show<W>(g, g.stage);
    differentiate<W>(g, g.stage, g.rate);
    add_scaled<W>(g, g.sum, g.sum, weight[stage], g.rate);
    rate = g.rate;
  }
  add_scaled<W>(g, g.state, g.state, dt / 6, g.sum);
  normalise<W>(g);
  show<W>(g, g.state);
}

template void show_gyrostat<QUADCORE_LANES>(const GyrostatStep&, const double*);
template void step_gyrostat<QUADCORE_LANES>(const GyrostatStep&, double);

}  // namespace quadcore
