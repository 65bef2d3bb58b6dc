#include "touching_points.hpp"

#include <cmath>

namespace quadcore {
namespace {

int rims(const Collision& shape, const Vector3d& p_WS, const Matrix3d& R_WS,
         Vector3d (&points_W)[most_touching_points]) {
  const double radius = shape.size.x(), length = shape.size.y();
  // Downward direction in the plane of the rims, in the shape's axes.
  double c = -R_WS(2, 0), s = -R_WS(2, 1);
  const double across = std::sqrt(c * c + s * s);
  c = across > 0 ? c / across : 1;
  s = across > 0 ? s / across : 0;
  const Vector3d lowest_W = radius * (R_WS.col(0) * c + R_WS.col(1) * s);
  const Vector3d quarter_W = radius * (R_WS.col(1) * c - R_WS.col(0) * s);
  int count = 0;
  for (const double half : {-length / 2, length / 2}) {
    const Vector3d center_W = p_WS + half * R_WS.col(2);
    points_W[count++] = center_W + lowest_W;
    points_W[count++] = center_W + quarter_W;
    points_W[count++] = center_W - lowest_W;
    points_W[count++] = center_W - quarter_W;
  }
  return count;
}

}  // namespace

int touching_points(const Collision& shape, const Vector3d& p_WS, const Matrix3d& R_WS,
                    Vector3d (&points_W)[most_touching_points]) {
  switch (shape.kind) {
    case ShapeKind::box:
      for (int i = 0; i < 8; ++i) {
        const Vector3d side(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
        points_W[i] = p_WS + R_WS * side.cwiseProduct(shape.size);
      }
      return 8;
    case ShapeKind::cylinder:
      return rims(shape, p_WS, R_WS, points_W);
    case ShapeKind::sphere:
      points_W[0] = p_WS - shape.size.x() * Vector3d::UnitZ();
      return 1;
    default:
      return 0;
  }
}

}  // namespace quadcore
