#include "cylinder_pair.hpp"

#include <ccd/ccd.h>

#include <cmath>
#include <limits>

#include "ode_math.hpp"

namespace quadcore {
namespace {

/// A cylinder about the z axis of its own frame C.
struct Cylinder {
  explicit Cylinder(dGeomID geom)
      : p_WC(vec(dGeomGetPosition(geom))), R_WC(rotation(dGeomGetRotation(geom))) {
    dGeomCylinderGetParams(geom, &radius, &length);
  }

  Vector3d p_WC;
  Matrix3d R_WC;
  dReal radius = 0, length = 0;
};

const Cylinder& cylinder(const void* object) { return *static_cast<const Cylinder*>(object); }

void copy(const Vector3d& from, ccd_vec3_t* to) { ccdVec3Set(to, from.x(), from.y(), from.z()); }

bool is_zero(double value) { return std::abs(value) < std::numeric_limits<double>::epsilon(); }

void find_center(const void* object, ccd_vec3_t* center) { copy(cylinder(object).p_WC, center); }

/// Find the point of a cylinder that lies farthest in a direction. If all points of a disc or of a
/// line do, it is their middle.
void find_farthest(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* farthest) {
  const Cylinder& self = cylinder(object);
  const Vector3d d_C = self.R_WC.transpose() * Vector3d(direction->v);
  const double across = std::sqrt(d_C.x() * d_C.x() + d_C.y() * d_C.y());
  Vector3d p_C = Vector3d::Zero();
  if (!is_zero(across)) p_C.head<2>() = self.radius / across * d_C.head<2>();
  if (!is_zero(d_C.z())) p_C.z() = std::copysign(self.length / 2, d_C.z());
  copy(self.R_WC * p_C + self.p_WC, farthest);
}

}  // namespace

bool are_cylinders(dGeomID one, dGeomID other) {
  return dGeomGetClass(one) == dCylinderClass && dGeomGetClass(other) == dCylinderClass;
}

int collide_cylinders(dGeomID one, dGeomID other, dContactGeom& point) {
  const Cylinder first(one), second(other);
  ccd_t search;
  CCD_INIT(&search);
  search.support1 = search.support2 = find_farthest;
  search.center1 = search.center2 = find_center;
  search.max_iterations = 500;  // these two as in ODE
  search.mpr_tolerance = 1e-6;
  ccd_real_t depth;
  ccd_vec3_t direction, position;
  if (ccdMPRPenetration(&first, &second, &search, &depth, &direction, &position) != 0) return 0;
  point.depth = depth;
  for (int i = 0; i < 3; ++i) {
    point.pos[i] = position.v[i];
    point.normal[i] = -direction.v[i];
  }
  return 1;
}

}  // namespace quadcore
