#pragma once

#include "quadcore/plugin/spatial.hpp"
#include "xml.hpp"

namespace quadcore {

/// A pose as SDF composes it: the rotation is a quaternion, so that no angle is lost at a pitch of
/// 90 degrees.
struct Placement {
  Vector3d position = Vector3d::Zero();
  Quaterniond rotation = Quaterniond::Identity();

  Placement operator*(const Placement& other) const {
    return {position + rotation * other.position, rotation * other.rotation};
  }
  Placement inverse() const { return {-(rotation.conjugate() * position), rotation.conjugate()}; }
};

/// Read "x y z roll pitch yaw" [m, rad]; an empty `<pose>` is the identity.
Placement read_placement(const Xml& xml, const Xml::Element& pose);

}  // namespace quadcore
