#include "contact_stiffness.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "touching_points.hpp"

namespace quadcore {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Return the stiffness matrix of an isotropic spring of 1 N/m at a point p_CQ from the vehicle's
/// centre of mass.
Matrix6d spring_at(const Vector3d& p_CQ) {
  Eigen::Matrix<double, 3, 6> J;  // Jacobian of the point's velocity
  J << Matrix3d::Identity(), -skew(p_CQ);
  return J.transpose() * J;
}

/// Return an upper bound for a spring anywhere on a ball: |a + b|^2 <= 2 |a|^2 + 2 |b|^2.
Matrix6d spring_on_ball(const Vector3d& p_CB, double radius) {
  Matrix6d spring = 2 * spring_at(p_CB);
  spring.bottomRightCorner<3, 3>() += 2 * radius * radius * Matrix3d::Identity();
  return spring;
}

struct Shape {
  std::size_t link;
  const Collision* collision;
  std::size_t points = 0;
  Matrix6d springs = Matrix6d::Zero();  ///< sum over all points
  double stiffness = 0;                 ///< relative to that of the other shapes
};

Shape measured(const Model& model, std::size_t link, const Collision& collision,
               const Eigen::Isometry3d& X_FL, const Vector3d& p_FC, PlacePoints place_points) {
  Shape shape{link, &collision};
  const Vector3d p_CS = X_FL * collision.pose.xyz - p_FC;
  const Matrix3d R_FS = X_FL.linear() * collision.pose.rotation().toRotationMatrix();
  const std::vector<Vector3d> points = place_points(collision, p_CS, R_FS);
  shape.points = points.size();
  if (collision.kind == ShapeKind::sphere) {
    shape.springs = spring_on_ball(p_CS, collision.size.x());
  } else if (link > 0 && !revolves(model, link, collision)) {
    const double swept = collision.pose.xyz.norm() + outer_radius(collision.kind, collision.size);
    shape.springs =
        static_cast<double>(shape.points) * spring_on_ball(X_FL.translation() - p_FC, swept);
  } else {
    for (const Vector3d& point : points) shape.springs += spring_at(point);
  }
  return shape;
}

/// Return the maximum lever about the joint's axis [m].
double lever(const Model& model, const Shape& shape) {
  const Vector3d& axis = model.joints[shape.link - 1].axis;
  return axis.cross(shape.collision->pose.xyz).norm() +
         outer_radius(shape.collision->kind, shape.collision->size);
}

}  // namespace

bool revolves(const Model& model, std::size_t link, const Collision& shape) {
  constexpr double tolerance = 1e-9;
  const Vector3d& axis = model.joints[link - 1].axis;
  if (axis.cross(shape.pose.xyz).norm() > tolerance) return false;
  if (shape.kind == ShapeKind::sphere) return true;
  const Vector3d z = shape.pose.rotation() * Vector3d::UnitZ();
  return shape.kind == ShapeKind::cylinder && axis.cross(z).norm() < tolerance;
}

std::vector<Vector3d> place_touching_points(const Collision& shape, const Vector3d& p,
                                            const Matrix3d& R) {
  Vector3d points[most_touching_points];
  const int count = touching_points(shape, p, R, points);
  return {points, points + count};
}

std::vector<StableContact> stable_contacts(const Model& model, const Gyrostat& body,
                                           PlacePoints place_points) {
  Matrix6d inertia = Matrix6d::Zero();
  inertia.topLeftCorner<3, 3>() = Matrix3d::Identity() / body.inverse_mass;
  inertia.bottomRightCorner<3, 3>() = body.inverse_reduced_I_F.inverse();
  const auto largest_square = [&](const Matrix6d& springs) {
    return Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d>(springs, inertia,
                                                              Eigen::EigenvaluesOnly)
        .eigenvalues()
        .maxCoeff();
  };
  const std::vector<Eigen::Isometry3d> poses = link_poses(model);
  std::vector<Shape> shapes;
  Matrix6d all = Matrix6d::Zero();
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    for (const Collision& collision : model.links[i].collisions) {
      Shape shape = measured(model, i, collision, poses[i], body.p_FCcm_F, place_points);
      shape.stiffness = 1 / largest_square(shape.springs);
      all += shape.stiffness * shape.springs;
      shapes.push_back(shape);
    }
  }
  std::vector<StableContact> contacts;
  if (shapes.empty()) return contacts;
  const double scale = largest_square_per_step / largest_square(all);
  for (const Shape& shape : shapes) {
    StableContact contact{scale * shape.stiffness, scale * shape.stiffness};
    if (shape.link > 0) {
      // Half of it moves the vehicle, and half turns the rotor.
      const auto sharing = static_cast<double>(model.links[shape.link].collisions.size());
      const double arm = lever(model, shape);
      const double turning = largest_square_per_step * moment_about_joint(model, shape.link - 1) /
                             (sharing * arm * arm);
      contact.rubbing = std::min(contact.rubbing, turning) / 2;
      if (!revolves(model, shape.link, *shape.collision)) {
        contact.pressing =
            std::min(contact.pressing, turning / static_cast<double>(shape.points)) / 2;
        contact.rubbing = std::min(contact.rubbing, contact.pressing);
      }
    }
    contacts.push_back(contact);
  }
  return contacts;
}

}  // namespace quadcore
