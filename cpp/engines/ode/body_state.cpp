#include "body_state.hpp"

#include <algorithm>

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
  dBodySetPosition(body, from[0], from[1], from[2]);  // also tells the body's shapes that it moved
}

void save_velocity(dBodyID body, double* to) {
  to = std::copy_n(dBodyGetLinearVel(body), 3, to);
  std::copy_n(dBodyGetAngularVel(body), 3, to);
}

void restore_velocity(dBodyID body, const double* from) {
  dBodySetLinearVel(body, from[0], from[1], from[2]);
  dBodySetAngularVel(body, from[3], from[4], from[5]);
}

void forget_forces(dBodyID body) {
  dBodySetForce(body, 0, 0, 0);
  dBodySetTorque(body, 0, 0, 0);
}

}  // namespace quadcore
