#include "constraint_rows.hpp"

#include <algorithm>

#include "hinge_angle.hpp"
#include "ode_math.hpp"

namespace quadcore {
namespace {

constexpr std::size_t rows_per_contact = 3;  // normal, and friction in two directions
constexpr double unlimited = 1e9;            // magnitude of a limit that nothing reaches

/// Pose of a body, or of the world.
struct BodyPose {
  Vector3d p_W = Vector3d::Zero();
  Matrix3d R_W = Matrix3d::Identity();
  laws::Quaternion<double> q_W = {0, 0, 0, 1};

  BodyPose() = default;
  explicit BodyPose(dBodyID body)
      : p_W(vec(dBodyGetPosition(body))), R_W(rotation(dBodyGetRotation(body))) {
    const dReal* const q = dBodyGetQuaternion(body);
    q_W = {q[1], q[2], q[3], q[0]};
  }
};

laws::Quaternion<double> to_laws(const Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }

/// Return the angle of a hinge from angle zero [rad].
double angle(const Hinge& hinge, const BodyPose& child, const BodyPose& parent) {
  const Vector3d& axis = hinge.axis_C;
  return hinge_angle(child.q_W, parent.q_W, to_laws(hinge.q_PC_at_zero),
                     {axis.x(), axis.y(), axis.z()});
}

/// Return the rotation that turns the child to its orientation at position zero [rad].
Vector3d turn_back(const Hinge& hinge, const BodyPose& child, const BodyPose& parent) {
  const laws::Quaternion<double>& q = child.q_W;
  const laws::Quaternion<double> back =
      parent.q_W * to_laws(hinge.q_PC_at_zero) * laws::Quaternion<double>{-q.x, -q.y, -q.z, q.w};
  return (back.w < 0 ? -2 : 2) * Vector3d(back.x, back.y, back.z);
}

/// Writes the rows of a hinge. A correction is the velocity of the child relative to the parent.
struct HingeWriter {
  const HingePlace& place;
  Vector3d arm_P_W;  ///< of the point where forces act on the parent
  ConstraintRow row;
  std::vector<ConstraintRow>& rows;

  void add(double correction) {
    row.correction = correction;
    rows.push_back(row);
    ++row.hinge_row;
  }
  void turn(const Vector3d& axis_W) {
    row.J[0] << Vector3d::Zero(), axis_W;
    row.J[1] = -row.J[0];
  }
  void move(const Vector3d& axis_W) {
    row.J[0] << axis_W, place.anchor_C_W.cross(axis_W);
    row.J[1] << -axis_W, -arm_P_W.cross(axis_W);
  }
};

}  // namespace

HingePlace::HingePlace(const Hinge& hinge, const Vector3d& p_WC, const Matrix3d& R_WC,
                       const Vector3d& p_WP, const Matrix3d& R_WP)
    : anchor_C_W(R_WC * hinge.anchor_C),
      anchor_P_W(R_WP * hinge.anchor_P),
      axis_W(R_WC * hinge.axis_C),
      gap_W(anchor_P_W + p_WP - anchor_C_W - p_WC),
      tilt_W(axis_W.cross(R_WP * hinge.axis_P)) {}

ConstraintRows::ConstraintRows(const std::vector<dBodyID>& bodies, std::vector<Hinge> hinges,
                               const std::vector<std::size_t>& order, const Options& options)
    : bodies_(bodies),
      hinges_(std::move(hinges)),
      newest_first_(order.rbegin(), order.rend()),
      options_(options),
      body_tagged_(bodies.size()),
      hinge_tagged_(hinges_.size()) {
  for (const std::size_t body : newest_first_) {
    for (std::size_t h = hinges_.size(); h-- > 0;) {
      if (hinges_[h].child == body) newest_hinges_first_.push_back(h);
    }
  }
  stack_.reserve(bodies_.size());
  reserve(0);
}

void ConstraintRows::reserve(std::size_t contacts) {
  rows_.reserve(rows_per_hinge * hinges_.size() + rows_per_contact * contacts);
  contact_tagged_.reserve(contacts);
}

const std::vector<ConstraintRow>& ConstraintRows::build(const std::vector<Contact>& contacts,
                                                        double dt, const BodyRange& range,
                                                        std::vector<char>& asleep) {
  rows_.clear();
  body_tagged_.assign(bodies_.size(), 0);
  hinge_tagged_.assign(hinges_.size(), 0);
  contact_tagged_.assign(contacts.size(), 0);
  for (const std::size_t newest : newest_first_) {
    if (!range.contains(newest) || body_tagged_[newest] || asleep[newest]) continue;
    reach(newest, asleep);
    while (!stack_.empty()) {
      const std::size_t body = stack_.back();
      stack_.pop_back();
      visit(body, contacts, dt, asleep);
    }
  }
  return rows_;
}

/// Put a body on the stack, the first time only.
void ConstraintRows::reach(std::size_t body, std::vector<char>& asleep) {
  if (body_tagged_[body]) return;
  body_tagged_[body] = 1;
  asleep[body] = 0;
  stack_.push_back(body);
}

void ConstraintRows::visit(std::size_t body, const std::vector<Contact>& contacts, double dt,
                           std::vector<char>& asleep) {
  for (std::size_t c = contacts.size(); c-- > 0;) {
    const Contact& contact = contacts[c];
    const bool is_other = contact.other == static_cast<int>(body);
    if (contact_tagged_[c] || (contact.body != body && !is_other)) continue;
    contact_tagged_[c] = 1;
    add_contact(contact, dt);
    if (contact.other < 0) continue;
    reach(is_other ? contact.body : static_cast<std::size_t>(contact.other), asleep);
  }
  for (const std::size_t h : newest_hinges_first_) {
    const Hinge& hinge = hinges_[h];
    if (hinge_tagged_[h] || (hinge.child != body && hinge.parent != body)) continue;
    hinge_tagged_[h] = 1;
    add_hinge(h, dt);
    const std::size_t other = hinge.child == body ? hinge.parent : hinge.child;
    if (other != Hinge::world) reach(other, asleep);
  }
}

void ConstraintRows::add_hinge(std::size_t index, double dt) {
  const Hinge& hinge = hinges_[index];
  const bool in_world = hinge.parent == Hinge::world;
  const BodyPose child(bodies_[hinge.child]);
  const BodyPose parent = in_world ? BodyPose() : BodyPose(bodies_[hinge.parent]);
  const HingePlace place(hinge, child.p_W, child.R_W, parent.p_W, parent.R_W);
  const double rate = options_.erp / dt;
  HingeWriter writer{place, place.anchor_P_W, {}, rows_};
  ConstraintRow& row = writer.row;
  row.body[0] = static_cast<int>(hinge.child);
  row.body[1] = in_world ? -1 : static_cast<int>(hinge.parent);
  row.max_correction = options_.max_hinge_correction;
  row.cfm = options_.cfm / dt;
  row.low = -dInfinity;
  row.high = dInfinity;
  row.hinge = static_cast<int>(index);

  if (hinge.kind == HingeKind::prismatic) {
    const Vector3d turn_W = turn_back(hinge, child, parent);
    for (int j = 0; j < 3; ++j) {
      writer.turn(Vector3d::Unit(j));
      writer.add(rate * turn_W[j]);
    }
    const Vector3d axis_W = parent.R_W * hinge.axis_P;
    writer.arm_P_W -= place.gap_W;
    for (const Vector3d& across_W : plane_space(axis_W)) {
      writer.move(across_W);
      writer.add(rate * place.gap_W.dot(across_W));
    }
    writer.move(axis_W);
    return add_along(hinge, -place.gap_W.dot(axis_W), dt, row);
  }
  // The anchors coincide.
  for (int j = 0; j < 3; ++j) {
    writer.move(Vector3d::Unit(j));
    writer.add(rate * place.gap_W[j]);
  }
  if (hinge.kind == HingeKind::ball) return;
  if (hinge.kind == HingeKind::universal) {
    // The axes are perpendicular.
    const Vector3d axis_P_W = parent.R_W * hinge.axis_P;
    writer.turn(place.axis_W.cross(axis_P_W).normalized());
    return writer.add(-rate * place.axis_W.dot(axis_P_W));
  }
  // The axes are parallel.
  for (const Vector3d& across_W : plane_space(place.axis_W)) {
    writer.turn(across_W);
    writer.add(rate * place.tilt_W.dot(across_W));
  }
  writer.turn(place.axis_W);
  const bool needs_angle = hinge.locked || hinge.lower > -unlimited || hinge.upper < unlimited;
  add_along(hinge, needs_angle ? angle(hinge, child, parent) : 0, dt, row);
}

/// Add the row of the direction in which a joint moves, if something acts there: a lock, a limit,
/// friction or implicit damping.
/// \param position  from position zero [rad, m]
/// \param row  with its Jacobians
void ConstraintRows::add_along(const Hinge& hinge, double position, double dt, ConstraintRow row) {
  const double rate = options_.erp / dt;
  row.correction = 0;
  if (hinge.locked) {
    row.correction = -rate * position;
  } else if (position <= hinge.lower) {
    row.correction = rate * (hinge.lower - position);
    row.low = 0;
  } else if (position >= hinge.upper) {
    row.correction = rate * (hinge.upper - position);
    row.high = 0;
  } else if (hinge.implicit_damping > 0) {
    row.cfm = 1 / hinge.implicit_damping / dt;
  } else if (hinge.friction > 0) {
    row.low = -hinge.friction;
    row.high = hinge.friction;
  } else {
    return;
  }
  rows_.push_back(row);
}

void ConstraintRows::add_contact(const Contact& contact, double dt) {
  const SurfacePair& surface = contact.surface;
  const double hardness = dt * surface.stiffness + surface.damping;
  const double erp = dt * surface.stiffness / hardness, cfm = 1 / hardness;
  ConstraintRow row;
  row.body[0] = static_cast<int>(contact.body);
  row.body[1] = contact.other;
  const auto push_along = [&](const Vector3d& along_W) {
    for (int side = 0; side < 2 && row.body[side] >= 0; ++side) {
      const dBodyID body = bodies_[static_cast<std::size_t>(row.body[side])];
      const Vector3d arm_W = contact.position_W - vec(dBodyGetPosition(body));
      row.J[side] << along_W, arm_W.cross(along_W);
      if (side == 1) row.J[side] = -row.J[side];
    }
  };
  push_along(contact.normal_W);
  row.correction = erp / dt * contact.depth;
  row.max_correction = surface.max_correction;
  row.cfm = cfm / dt;
  row.high = dInfinity;
  if (surface.bounce > 0) {
    const double parting = speed_along(row);
    const double rebound = -surface.bounce * parting;
    if (-parting > surface.bounce_speed && rebound > row.correction) {
      row.correction = row.max_correction = rebound;
    }
  }
  const int normal = static_cast<int>(rows_.size());
  rows_.push_back(row);

  row.correction = 0;
  row.normal = normal;
  std::array<Vector3d, 2> along_W = {contact.fdir1_W, contact.normal_W.cross(contact.fdir1_W)};
  if (along_W[1].isZero(1e-12)) along_W = plane_space(contact.normal_W);
  const std::array<double, 2> friction = {surface.mu1, surface.mu2};
  const std::array<double, 2> slip = {surface.slip1, surface.slip2};
  for (std::size_t i = 0; i < 2; ++i) {
    push_along(along_W[i]);
    row.friction = friction[i];
    row.cfm = slip[i] / dt;
    rows_.push_back(row);
  }
}

/// Return the velocity of a row's bodies along it.
double ConstraintRows::speed_along(const ConstraintRow& row) const {
  double speed = 0;
  for (int side = 0; side < 2 && row.body[side] >= 0; ++side) {
    const dBodyID body = bodies_[static_cast<std::size_t>(row.body[side])];
    speed += row.J[side].head<3>().dot(vec(dBodyGetLinearVel(body))) +
             row.J[side].tail<3>().dot(vec(dBodyGetAngularVel(body)));
  }
  return speed;
}

}  // namespace quadcore
