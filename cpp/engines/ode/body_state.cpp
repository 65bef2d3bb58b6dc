#include "body_state.hpp"

#include <algorithm>

#include "laws/turned_by.hpp"
#include "ode_math.hpp"

namespace quadcore {
namespace {

/// The getters return the body's own arrays.
double* writable(const dReal* own) { return const_cast<double*>(own); }

}  // namespace

void save_pose(dBodyID body, double* to) {
  to = std::copy_n(dBodyGetPosition(body), 3, to);
  to = std::copy_n(dBodyGetQuaternion(body), 4, to);
  std::copy_n(dBodyGetRotation(body), 12, to);
}

void restore_pose(dBodyID body, const double* from) {
  std::copy_n(from + 3, 4, writable(dBodyGetQuaternion(body)));
  std::copy_n(from + 7, 12, writable(dBodyGetRotation(body)));
  dBodySetPosition(body, from[0], from[1], from[2]);  // also updates the body's shapes
}

void save_velocity(dBodyID body, double* to) {
  to = std::copy_n(dBodyGetLinearVel(body), 3, to);
  std::copy_n(dBodyGetAngularVel(body), 3, to);
}

void restore_velocity(dBodyID body, const double* from) {
  dBodySetLinearVel(body, from[0], from[1], from[2]);
  dBodySetAngularVel(body, from[3], from[4], from[5]);
}

void move_pose(dBodyID body, const Vector3d& v_W, const Vector3d& w_W, double dt) {
  const Vector3d p_W = vec(dBodyGetPosition(body)) + dt * v_W;
  const Vector3d h_W = dt / 2 * w_W;
  const dReal* const old = dBodyGetQuaternion(body);
  const auto q =
      laws::turned_by<double>({h_W.x(), h_W.y(), h_W.z()}, {old[1], old[2], old[3], old[0]});
  const dQuaternion next = {q.w, q.x, q.y, q.z};
  dBodySetPosition(body, p_W.x(), p_W.y(), p_W.z());
  dBodySetQuaternion(body, next);
}

void forget_forces(dBodyID body) {
  dBodySetForce(body, 0, 0, 0);
  dBodySetTorque(body, 0, 0, 0);
}

}  // namespace quadcore
