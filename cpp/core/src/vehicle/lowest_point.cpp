#include "lowest_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "quadcore/plugin/error.hpp"

namespace quadcore {

double reach_down(const Collision& shape, const Matrix3d& R_WS) {
  const Eigen::RowVector3d down = R_WS.row(2);
  switch (shape.kind) {
    case ShapeKind::box:
      return down.cwiseAbs().dot(shape.size) / 2;
    case ShapeKind::cylinder: {
      const double radius = shape.size.x(), length = shape.size.y();
      return radius * down.head<2>().norm() + length / 2 * std::abs(down.z());
    }
    case ShapeKind::sphere:
      return shape.size.x();
    default:
      return 0;
  }
}

double lowest_point(const Model& model, const Kinematics& k) {
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const Inertial& inertial = model.links[i].inertial;
    const Matrix3d R_WL = i == 0 ? k.R_WF : (k.R_WF * k.R_FR(i - 1)).eval();
    const Vector3d p_WL =
        i == 0 ? k.p_WF
               : (k.p_WF + k.R_WF * k.rotors[i - 1].p_FRcm_F - R_WL * inertial.pose.xyz).eval();
    for (const Collision& shape : model.links[i].collisions) {
      const Matrix3d R_WS = R_WL * shape.pose.rotation().toRotationMatrix();
      const double center = p_WL.z() + R_WL.row(2).dot(shape.pose.xyz);
      lowest = std::min(lowest, center - reach_down(shape, R_WS));
    }
  }
  return lowest;
}

void check_collisions(const Model& model) {
  for (const Link& link : model.links) {
    for (const Collision& collision : link.collisions) {
      if (collision.kind == ShapeKind::mesh) {
        throw InputError(collision.where +
                         ": contact of a collision mesh with the ground is not modelled. Use a "
                         "box, cylinder or sphere, or a world without ground.");
      }
    }
  }
}

}  // namespace quadcore
