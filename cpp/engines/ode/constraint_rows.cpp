#include "constraint_rows.hpp"

#include <algorithm>

#include "hinge_angle.hpp"
#include "ode_math.hpp"

namespace quadcore {
namespace {

constexpr std::size_t rows_per_contact = 3;  // normal, and friction in two directions

laws::Quaternion<double> orientation(dBodyID body) {
  const dReal* const q = dBodyGetQuaternion(body);
  return {q[1], q[2], q[3], q[0]};
}

/// Return the angle of a hinge from its locked position [rad].
double angle(const Hinge& hinge, dBodyID child, dBodyID parent) {
  const Quaterniond& q = hinge.q_PC_at_zero;
  const Vector3d& axis = hinge.axis_C;
  return hinge_angle(orientation(child), orientation(parent), {q.x(), q.y(), q.z(), q.w()},
                     {axis.x(), axis.y(), axis.z()});
}

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
  stack_.reserve(bodies_.size());
  reserve(0);
}

void ConstraintRows::reserve(std::size_t contacts) {
  rows_.reserve(rows_per_hinge * hinges_.size() + rows_per_contact * contacts);
}

const std::vector<ConstraintRow>& ConstraintRows::build(const std::vector<Contact>& contacts,
                                                        double dt) {
  rows_.clear();
  body_tagged_.assign(bodies_.size(), 0);
  hinge_tagged_.assign(hinges_.size(), 0);
  for (const std::size_t newest : newest_first_) {
    if (body_tagged_[newest]) continue;
    stack_.push_back(newest);  // no mark needed: the marks of the hinges prevent a return
    while (!stack_.empty()) {
      const std::size_t body = stack_.back();
      stack_.pop_back();
      visit(body, contacts, dt);
    }
  }
  return rows_;
}

void ConstraintRows::visit(std::size_t body, const std::vector<Contact>& contacts, double dt) {
  for (auto contact = contacts.rbegin(); contact != contacts.rend(); ++contact) {
    if (contact->body == body) add_contact(*contact, dt);
  }
  for (const std::size_t child : newest_first_) {
    if (child == 0) continue;  // the frame has no hinge
    const std::size_t h = child - 1;
    const Hinge& hinge = hinges_[h];
    if (hinge_tagged_[h] || (hinge.child != body && hinge.parent != body)) continue;
    hinge_tagged_[h] = 1;
    add_hinge(h, dt);
    const std::size_t other = hinge.child == body ? hinge.parent : hinge.child;
    if (body_tagged_[other]) continue;
    body_tagged_[other] = 1;
    stack_.push_back(other);
  }
}

void ConstraintRows::add_hinge(std::size_t index, double dt) {
  const Hinge& hinge = hinges_[index];
  const dBodyID child = bodies_[hinge.child], parent = bodies_[hinge.parent];
  const HingePlace place(hinge, vec(dBodyGetPosition(child)), rotation(dBodyGetRotation(child)),
                         vec(dBodyGetPosition(parent)), rotation(dBodyGetRotation(parent)));
  const double rate = options_.erp / dt;
  ConstraintRow row;
  row.body[0] = static_cast<int>(hinge.child);
  row.body[1] = static_cast<int>(hinge.parent);
  row.max_correction = options_.max_hinge_correction;
  row.cfm = options_.cfm / dt;
  row.low = -dInfinity;
  row.high = dInfinity;
  row.hinge = static_cast<int>(index);

  // The anchors coincide.
  for (int j = 0; j < 3; ++j) {
    const Vector3d along_W = Vector3d::Unit(j);
    row.J[0] << along_W, place.anchor_C_W.cross(along_W);
    row.J[1] << -along_W, -place.anchor_P_W.cross(along_W);
    row.correction = rate * place.gap_W[j];
    row.hinge_row = j;
    rows_.push_back(row);
  }
  // The axes are parallel.
  for (const Vector3d& across_W : plane_space(place.axis_W)) {
    row.J[0] << Vector3d::Zero(), across_W;
    row.J[1] = -row.J[0];
    row.correction = rate * place.tilt_W.dot(across_W);
    ++row.hinge_row;
    rows_.push_back(row);
  }
  if (hinge.friction == 0 && hinge.implicit_damping == 0 && !hinge.locked) return;
  // The joint stays at rest as far as friction or implicit damping allows.
  row.J[0] << Vector3d::Zero(), place.axis_W;
  row.J[1] = -row.J[0];
  row.correction = 0;
  ++row.hinge_row;
  if (hinge.locked) {
    row.correction = -rate * angle(hinge, child, parent);
  } else if (hinge.implicit_damping > 0) {
    row.cfm = 1 / hinge.implicit_damping / dt;
  } else {
    row.low = -hinge.friction;
    row.high = hinge.friction;
  }
  rows_.push_back(row);
}

void ConstraintRows::add_contact(const Contact& contact, double dt) {
  const SurfacePair& surface = contact.surface;
  const double hardness = dt * surface.stiffness + surface.damping;
  const double erp = dt * surface.stiffness / hardness, cfm = 1 / hardness;
  const Vector3d arm_W = contact.position_W - vec(dBodyGetPosition(bodies_[contact.body]));
  ConstraintRow row;
  row.body[0] = static_cast<int>(contact.body);
  row.J[0] << contact.normal_W, arm_W.cross(contact.normal_W);
  row.correction = erp / dt * contact.depth;
  row.max_correction = surface.max_correction;
  row.cfm = cfm / dt;
  row.high = dInfinity;
  const int normal = static_cast<int>(rows_.size());
  rows_.push_back(row);

  row.correction = 0;
  row.normal = normal;
  std::array<Vector3d, 2> along_W = {contact.fdir1_W, contact.normal_W.cross(contact.fdir1_W)};
  if (along_W[1].isZero(1e-12)) along_W = plane_space(contact.normal_W);
  const std::array<double, 2> friction = {surface.mu1, surface.mu2};
  const std::array<double, 2> slip = {surface.slip1, surface.slip2};
  for (std::size_t i = 0; i < 2; ++i) {
    row.J[0] << along_W[i], arm_W.cross(along_W[i]);
    row.friction = friction[i];
    row.cfm = slip[i] / dt;
    rows_.push_back(row);
  }
}

}  // namespace quadcore
