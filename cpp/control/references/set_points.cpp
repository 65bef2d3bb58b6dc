#include "references/set_points.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/error.hpp"
#include "references/septic_path.hpp"

namespace quadcore::control {
namespace {

class Held final : public ReferenceShape {
 public:
  explicit Held(const Reference& wanted) : wanted_(wanted) {}
  Reference at(double) const override { return wanted_; }

 private:
  Reference wanted_;
};

Vector3d turned(const Vector3d& v, double yaw) {
  const auto [s, c] = elementary::sincos(yaw);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y(), v.z()};
}

/// sin(x)/x
double sinc(double x) { return std::abs(x) < 1e-4 ? 1 - x * x / 6 : elementary::sincos(x).sin / x; }

class Drive final : public ReferenceShape {
 public:
  Drive(const Reference& from, const Heading& heading, double lasts)
      : position_(from.position), yaw_(from.yaw), heading_(heading), lasts_(lasts) {}

  Reference at(double t) const override {
    const Vector3d& v = heading_.velocity;
    const double rate = heading_.yaw_rate;
    const double time = std::min(t, lasts_), turn = rate * time;
    Reference wanted;
    wanted.yaw = yaw_ + turn;
    // The mean of a rotating velocity is the velocity in the middle, times sin(turn/2)/(turn/2).
    Vector3d way = time * turned(v, yaw_ + turn / 2);
    way.head<2>() *= sinc(turn / 2);
    wanted.position = position_ + way;
    if (t >= lasts_) return wanted;
    const auto derivative = [rate](const Vector3d& x) {
      return Vector3d(-rate * x.y(), rate * x.x(), 0);
    };
    wanted.velocity = turned(v, wanted.yaw);
    wanted.acceleration = derivative(wanted.velocity);
    wanted.jerk = derivative(wanted.acceleration);
    wanted.snap = derivative(wanted.jerk);
    wanted.yaw_rate = rate;
    return wanted;
  }
  double end() const override { return lasts_; }

 private:
  Vector3d position_;
  double yaw_;
  Heading heading_;
  double lasts_;
};

/// Return the equivalent yaw that is nearest to another.
double near(double yaw, double other) {
  return yaw + 2 * M_PI * std::round((other - yaw) / (2 * M_PI));
}

}  // namespace

std::unique_ptr<ReferenceShape> hold(const Reference& wanted) {
  return std::make_unique<Held>(wanted);
}

std::unique_ptr<ReferenceShape> drive(const Reference& from, const Heading& heading, double lasts) {
  return std::make_unique<Drive>(from, heading, lasts);
}

std::unique_ptr<ReferenceShape> through(const Reference& from,
                                        const std::vector<PathPoint>& points) {
  if (points.empty()) throw InputError("the path has no points. Give at least one.");
  if (!(points.front().t >= 0)) throw InputError("the path starts at a negative time. Start at 0.");
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i].t > points[i - 1].t) continue;
    throw InputError("point " + std::to_string(i + 1) +
                     " of the path is not later than the one before. Sort the points by time.");
  }
  std::vector<SepticPath::Point> path;
  if (points.front().t > 0) {
    path.emplace_back();
    path.back().t = 0;
    path.back().derivatives.leftCols<3>() << from.position.transpose(), from.velocity.transpose(),
        from.acceleration.transpose(), from.jerk.transpose();
    path.back().derivatives.col(3) << from.yaw, from.yaw_rate, from.yaw_acceleration, 0;
    path.back().given = {true, true, true};
  }
  double yaw = from.yaw;
  for (const PathPoint& point : points) {
    path.emplace_back();
    SepticPath::Point& p = path.back();
    p.t = point.t;
    yaw = near(point.yaw, yaw);
    p.derivatives.row(0) << point.position.transpose(), yaw;
    int k = 1;
    for (const auto& change : {point.velocity, point.acceleration}) {
      if (change) p.derivatives.row(k) << change->of_position.transpose(), change->of_yaw;
      p.given[static_cast<std::size_t>(k) - 1] = change.has_value();
      ++k;
    }
  }
  if (path.size() == 1) {
    const Eigen::Matrix4d& d = path.front().derivatives;
    Reference wanted;
    wanted.position = d.row(0).head<3>();
    wanted.velocity = d.row(1).head<3>();
    wanted.acceleration = d.row(2).head<3>();
    wanted.yaw = d(0, 3);
    wanted.yaw_rate = d(1, 3);
    wanted.yaw_acceleration = d(2, 3);
    return hold(wanted);
  }
  path.front().given = path.back().given = {true, true, true};  // zero by default
  return std::make_unique<SepticPath>(SepticPath::smoothest(path));
}

}  // namespace quadcore::control
