#pragma once

#include "body_work.hpp"
#include "hinge_angle.hpp"
#include "hinged_tree.hpp"
#include "lanes/four.hpp"
#include "lanes/table.hpp"
#include "laws/turned_by.hpp"
#include "quadcore/plugin/rotor_layout.hpp"

namespace quadcore {

/// Number of lanes.
enum class Lanes { vehicles, rotors };

/// A step of ODE's direct solver (dWorldStep) in linear time. For the accelerations a and the
/// multipliers l, ODE requires
///   M a = f + J^T l,   J a + (cfm/dt) l = (ERP/dt error - J v)/dt,
/// and moves with the velocities at the end of the step. On a tree of hinges, a child's
/// acceleration is the sum of its carrier's, the acceleration that its hinge's rows require, and a
/// rotation about the axis, which no row resists unless the hinge is locked. Starting at the
/// leaves, each child passes inertia and force to its carrier with this rotation eliminated
/// (cpp/physics/laws/articulated.hpp), instead of solving for all multipliers at once. If cfm makes
/// the rows compliant, each row is eliminated like a rotation. Lanes are vehicles, or the rotors of
/// one vehicle with all hinges on its frame. In the latter case the frame is the same in all lanes,
/// and the contributions of the rotors are summed in their order.
template <class T, Lanes lanes>
class HingedBodies {
 public:
  using Table = laws::Table<T, widest_lanes>;
  static constexpr bool are_rotors = lanes == Lanes::rotors;

  /// Tables of BodyConstant and BodyRow, and work memory for each body; for its hinge's rows only
  /// if they are compliant.
  QUADCORE_LAW HingedBodies(const HingedTree& tree, const double* constants, double* state,
                            BodyWork<T>* work, SoftRows<T>* soft)
      : tree_(tree), constants_(constants), state_(state), work_(work), soft_(soft) {
    if constexpr (are_rotors)
      bodies_ = 1 + (tree.bodies + laws::lanes_of<T> - 2) / laws::lanes_of<T>;
  }

  /// Return the number of bodies of each vehicle, or of packs of them.
  QUADCORE_LAW std::size_t size() const {
    if constexpr (are_rotors) return bodies_;
    return tree_.bodies;
  }
  QUADCORE_LAW Table constants(std::size_t body) const {
    return {constants_ + place(BodyConstant::count, body)};
  }
  QUADCORE_LAW Table state(std::size_t body) const {
    return {state_ + place(BodyRow::count, body)};
  }
  QUADCORE_LAW BodyWork<T>& work(std::size_t body) const { return work_[body]; }
  QUADCORE_LAW std::size_t carrier(std::size_t body) const {
    if constexpr (are_rotors && laws::lanes_of<T> > 1) return 0;
    return tree_.carriers[body];
  }
  /// Add numbers of the bodies of a pack to those of their carrier.
  QUADCORE_LAW void add_to_carrier([[maybe_unused]] std::size_t body, T& sum, T numbers) const {
    if constexpr (are_rotors && laws::lanes_of<T> > 1) {
      double total = sum[0];
      for (std::size_t lane = used_lanes(body); lane-- > 0;) total += numbers[lane];
      sum = laws::broadcast<T>(total);
    } else {
      sum = sum + numbers;
    }
  }
  /// Add four numbers of the bodies of a pack to a, b, c and d of their carrier.
  QUADCORE_LAW void add_to_carrier(std::size_t body, T& a, T& b, T& c, T& d, T to_a, T to_b, T to_c,
                                   T to_d) const {
    if constexpr (are_rotors && laws::lanes_of<T> == 4) {
      if (used_lanes(body) == 4) {
        return laws::add_lanes_backwards(a, b, c, d, to_a, to_b, to_c, to_d);
      }
    }
    add_to_carrier(body, a, to_a);
    add_to_carrier(body, b, to_b);
    add_to_carrier(body, c, to_c);
    add_to_carrier(body, d, to_d);
  }

  /// Compute the geometry of the bodies.
  QUADCORE_LAW void read() {
    for (std::size_t i = 0; i < size(); ++i) {
      BodyWork<T>& body = work(i);
      const Table state = this->state(i);
      body.R_WB = laws::rotation(q_WB(state));
      if (i > 0) body.axis_W = body.R_WB * constants(i).vector(BodyConstant::axis_C);
    }
  }

  /// Set the forces on the bodies to zero.
  QUADCORE_LAW void clear_forces() {
    for (std::size_t i = 0; i < size(); ++i) {
      work(i).force = none();
      work(i).torque = T{};
      if (!tree_.carries[i]) continue;
      laws::for_each(work(i).carried, work(i).carried,
                     [](T& number, const T&) QUADCORE_INLINED { number = T{}; });
      work(i).borne = none();
    }
  }

  /// Add the torque -w x (I w) of each body with its own rate, see add_gyroscopic_per_body().
  QUADCORE_LAW void turn_inertias(bool gyroscopic) {
    for (std::size_t i = 0; i < size(); ++i) {
      BodyWork<T>& body = work(i);
      body.I_Bcm_W = turned(body.R_WB, constants(i).symmetric(BodyConstant::inertia));
      if (!gyroscopic) continue;
      const Vec3<T> w_W = state(i).vector(BodyRow::rate);
      body.force.angular = body.force.angular - laws::cross(w_W, body.I_Bcm_W * w_W);
    }
  }

  /// Compute the geometry of the hinges in a step of dt. Returns the square of the maximum
  /// correction that a hinge requires [m/s, rad/s].
  QUADCORE_LAW T read_hinges(double dt) {
    work(0).p_OBcm_W = {T{}, T{}, T{}};
    T largest{};
    for (std::size_t i = 1; i < size(); ++i) {
      const T square = read_hinge(i, dt);
      largest = laws::chosen_by(square > largest, square, largest);
    }
    return largest;
  }
  /// Maximum correction for which this step agrees with Gazebo.
  QUADCORE_LAW double max_correction_squared() const {
    return tree_.max_correction * tree_.max_correction;
  }

  /// Advance by the dt for which the hinges were read, under the added forces.
  QUADCORE_LAW void advance(double dt) {
    for (std::size_t i = size(); i-- > 1;) eliminate(i, dt);
    work(0).acceleration = laws::solve(felt(0), at_O(0, {T{}, T{}, T{}}));
    move(0, dt);
    for (std::size_t i = 1; i < size(); ++i) {
      accelerate(i);
      move(i, dt);
    }
  }

  /// Return the rate of a body's hinge about its axis [rad/s].
  QUADCORE_LAW T joint_rate(std::size_t i) const {
    return laws::dot(work(i).axis_W,
                     state(i).vector(BodyRow::rate) - state(carrier(i)).vector(BodyRow::rate));
  }

  /// Return the load of a body's hinge on it and the bodies it carries, at O, in the last step.
  QUADCORE_LAW Spatial<T> load_of_hinge(std::size_t i) const {
    const Spatial<T>& a = work(i).acceleration;
    // About the axis during the step; the end of the step has rotated it.
    Spatial<T> load = body_load(i, a) - at_O(i, work(i).turn.direction.angular);
    if (tree_.carries[i]) load = load + work(i).carried * a;
    return load;
  }

 private:
  QUADCORE_LAW static laws::Quaternion<T> q_WB(const Table& state) {
    return {state.number(BodyRow::orientation), state.number(BodyRow::orientation + 1),
            state.number(BodyRow::orientation + 2), state.number(BodyRow::orientation + 3)};
  }
  /// Return the angle of a body's hinge for ODE's stops; lanes have no stops.
  QUADCORE_LAW T joint_angle([[maybe_unused]] std::size_t i) const {
    if constexpr (laws::lanes_of<T> > 1) {
      return T{};
    } else {
      const Table at = constants(i);
      const std::size_t q = BodyConstant::q_PC_at_zero;
      return hinge_angle(q_WB(state(i)), q_WB(state(carrier(i))),
                         {at.number(q), at.number(q + 1), at.number(q + 2), at.number(q + 3)},
                         at.vector(BodyConstant::axis_C));
    }
  }
  QUADCORE_LAW static Spatial<T> none() { return {Vec3<T>{T{}, T{}, T{}}, Vec3<T>{T{}, T{}, T{}}}; }

  /// R I R^T
  QUADCORE_LAW static laws::Symmetric3<T> turned(const Matrix3<T>& R,
                                                 const laws::Symmetric3<T>& I) {
    const Vec3<T> x{R.xx, R.xy, R.xz}, y{R.yx, R.yy, R.yz}, z{R.zx, R.zy, R.zz};
    const Vec3<T> I_x = I * x, I_y = I * y, I_z = I * z;
    return {laws::dot(x, I_x), laws::dot(x, I_y), laws::dot(x, I_z),
            laws::dot(y, I_y), laws::dot(y, I_z), laws::dot(z, I_z)};
  }

  /// Returns the square of its maximum correction.
  QUADCORE_LAW T read_hinge(std::size_t i, double dt) {
    const Table at = constants(i), child = state(i), parent = state(carrier(i));
    BodyWork<T>& body = work(i);
    const BodyWork<T>& of_parent = work(carrier(i));
    const Vec3<T> anchor_C_W = body.R_WB * at.vector(BodyConstant::origin);
    const Vec3<T> anchor_P_W = of_parent.R_WB * at.vector(BodyConstant::anchor_P);
    body.p_OA_W = of_parent.p_OBcm_W + anchor_P_W;
    body.p_OBcm_W = body.p_OA_W - anchor_C_W;
    // Rows: the anchors coincide, and the axes are parallel.
    const Vec3<T> gap_W = (anchor_P_W + parent.vector(BodyRow::position)) -
                          (anchor_C_W + child.vector(BodyRow::position));
    const Vec3<T> tilt_W =
        laws::cross(body.axis_W, of_parent.R_WB * at.vector(BodyConstant::axis_P));
    const Vec3<T> w_WC_W = child.vector(BodyRow::rate), w_WP_W = parent.vector(BodyRow::rate);
    const Vec3<T> slip_W = (child.vector(BodyRow::velocity) + laws::cross(w_WC_W, anchor_C_W)) -
                           (parent.vector(BodyRow::velocity) + laws::cross(w_WP_W, anchor_P_W));
    const Vec3<T> turn_W = w_WC_W - w_WP_W;
    const Vec3<T> bent_W = turn_W - laws::dot(body.axis_W, turn_W) * body.axis_W;
    const double per_step = 1 / dt, rate = tree_.erp / dt;
    body.wanted.angular = per_step * (rate * tilt_W - bent_W);
    body.wanted.linear =
        per_step * (rate * gap_W - slip_W) + laws::cross(body.p_OA_W, body.wanted.angular);
    const T gap = laws::dot(gap_W, gap_W), tilt = laws::dot(tilt_W, tilt_W);
    T largest = laws::chosen_by(gap > tilt, gap, tilt);
    if (tree_.locks[i]) {
      const T angle = joint_angle(i);
      largest = laws::chosen_by(angle * angle > largest, angle * angle, largest);
    }
    return (rate * rate) * largest;
  }

  /// Return the forces on a body and by the bodies it carries, at O; about the axis the torque of
  /// its joint.
  QUADCORE_LAW Spatial<T> at_O(std::size_t i, const Vec3<T>& axis_W) const {
    const BodyWork<T>& body = work(i);
    const T weight = constants(i).number(BodyConstant::weight);
    const double* g_W = tree_.gravity_W;
    const Vec3<T> f_W =
        body.force.linear + Vec3<T>{weight * g_W[0], weight * g_W[1], weight * g_W[2]};
    Spatial<T> sum{f_W, body.force.angular + laws::cross(body.p_OBcm_W, f_W)};
    if (i > 0) sum.angular = sum.angular + body.torque * axis_W;
    return tree_.carries[i] ? sum + body.borne : sum;
  }

  QUADCORE_LAW Spatial<T> body_load(std::size_t i, const Spatial<T>& a) const {
    return laws::body_load(constants(i).number(BodyConstant::mass), work(i).p_OBcm_W,
                           work(i).I_Bcm_W, a);
  }

  QUADCORE_LAW laws::SpatialInertia<T> felt(std::size_t i) const {
    laws::SpatialInertia<T> sum = laws::body_inertia(constants(i).number(BodyConstant::mass),
                                                     work(i).p_OBcm_W, work(i).I_Bcm_W);
    if (tree_.carries[i]) {
      laws::for_each(sum, work(i).carried, [](T& a, const T& b) QUADCORE_INLINED { a = a + b; });
    }
    return sum;
  }

  QUADCORE_LAW void eliminate(std::size_t i, double dt) {
    BodyWork<T>& body = work(i);
    laws::SpatialInertia<T> felt = this->felt(i);
    Spatial<T> force = at_O(i, body.axis_W);
    const Spatial<T> turn{laws::cross(body.p_OA_W, body.axis_W), body.axis_W};
    Spatial<T> load = body_load(i, turn);
    if (tree_.carries[i]) load = load + body.carried * turn;
    if (tree_.brakes[i]) {
      // At the end of the step, rate + torque of the hinge/damping = 0.
      const T softness = 1 / (dt * constants(i).number(BodyConstant::implicit_damping));
      body.turn = laws::soft_to(turn, load, force, -joint_rate(i) / dt, softness);
    } else if (tree_.locks[i]) {
      // A sixth row: the joint is at angle zero.
      const T wanted = (-(tree_.erp / dt) * joint_angle(i) - joint_rate(i)) / dt;
      body.turn = laws::soft_to(turn, load, force, wanted, T{} + tree_.cfm / dt);
    } else {
      body.turn = laws::free_to(turn, load, force);
    }
    laws::eliminate(body.turn, felt, force);
    if (soft_) {
      eliminate_rows(i, dt, felt, force);
    } else {
      force = force - felt * body.wanted;
    }
    force.angular = force.angular - body.torque * body.axis_W;
    BodyWork<T>& parent = work(carrier(i));
    const auto add = [&](auto&&... sums_and_numbers)
                         QUADCORE_INLINED { add_to_carrier(i, sums_and_numbers...); };
    laws::for_each_four(parent.carried, felt, add);
    laws::for_each_four(parent.borne, force, add);
  }

  QUADCORE_LAW void eliminate_rows(std::size_t i, double dt, laws::SpatialInertia<T>& felt,
                                   Spatial<T>& force) {
    const BodyWork<T>& body = work(i);
    const T none{}, one = none + 1, softness = none + tree_.cfm / dt;
    const Vec3<T>& bent_W = body.wanted.angular;
    const Vec3<T> slipped_W = body.wanted.linear - laws::cross(body.p_OA_W, bent_W);
    laws::Freedom<T>* row = soft_[i].rows;
    const auto give_way = [&](const Spatial<T>& direction, T wanted) QUADCORE_INLINED {
      *row = laws::soft_to(direction, felt * direction, force, wanted, softness);
      laws::eliminate(*row++, felt, force);
    };
    const Vec3<T> zero{none, none, none};
    give_way({{one, none, none}, zero}, slipped_W.x);
    give_way({{none, one, none}, zero}, slipped_W.y);
    give_way({{none, none, one}, zero}, slipped_W.z);
    for (std::size_t k = 0; k < 2; ++k) {
      const Vec3<T> across_W = body.R_WB * constants(i).vector(BodyConstant::across_C + 3 * k);
      give_way({laws::cross(body.p_OA_W, across_W), across_W}, laws::dot(across_W, bent_W));
    }
  }

  QUADCORE_LAW void accelerate(std::size_t i) {
    BodyWork<T>& body = work(i);
    Spatial<T> a = work(carrier(i)).acceleration;
    if (soft_) {
      for (std::size_t k = 5; k-- > 0;) soft_[i].rows[k].add_to(a);
    } else {
      a = a + body.wanted;
    }
    body.turn.add_to(a);
    body.acceleration = a;
  }

  /// Move like ODE: update the velocities, then the poses with the new velocities.
  QUADCORE_LAW void move(std::size_t i, double dt) {
    const BodyWork<T>& body = work(i);
    const Table from = state(i);
    double* const to = state_ + place(BodyRow::count, i);
    const auto put = [to](std::size_t row, T number)
                         QUADCORE_INLINED { laws::store(to + row * widest_lanes, number); };
    const auto put3 = [&](std::size_t row, const Vec3<T>& a)
                          QUADCORE_INLINED { put(row, a.x), put(row + 1, a.y), put(row + 2, a.z); };
    const Spatial<T>& a = body.acceleration;
    const Vec3<T> v_W =
        from.vector(BodyRow::velocity) + dt * (a.linear + laws::cross(a.angular, body.p_OBcm_W));
    const Vec3<T> w_W = from.vector(BodyRow::rate) + dt * a.angular;
    put3(BodyRow::velocity, v_W);
    put3(BodyRow::rate, w_W);
    put3(BodyRow::position, from.vector(BodyRow::position) + dt * v_W);
    const auto q = laws::turned_by((dt / 2) * w_W, q_WB(from));
    const T by = 1 / laws::square_root((q.x * q.x + q.y * q.y) + (q.z * q.z + q.w * q.w));
    put3(BodyRow::orientation, by * Vec3<T>{q.x, q.y, q.z});
    put(BodyRow::orientation + 3, by * q.w);
  }

  /// Return the offset of a body in a table of so many rows.
  QUADCORE_LAW static std::size_t place(std::size_t rows, std::size_t body) {
    if constexpr (!are_rotors) return body * rows * widest_lanes;
    if (body == 0) return 0;
    return rows * widest_lanes + rotor_offset(rows, (body - 1) * laws::lanes_of<T>);
  }
  QUADCORE_LAW std::size_t used_lanes(std::size_t body) const {
    constexpr std::size_t all = laws::lanes_of<T>;
    const std::size_t left = tree_.bodies - 1 - (body - 1) * all;
    return left < all ? left : all;
  }

  const HingedTree& tree_;
  std::size_t bodies_ = 0;
  const double* constants_;
  double* state_;
  BodyWork<T>* work_;
  SoftRows<T>* soft_;
};

}  // namespace quadcore
