#include <algorithm>
#include <cmath>
#include <limits>

#include "quadcore/plugin/elementary.hpp"
#include "quadcore/plugin/error.hpp"
#include "references/row_fit.hpp"
#include "references/septic_path.hpp"
#include "references/shapes.hpp"

namespace quadcore::control {
namespace {

using T = TagSpec;

constexpr Eigen::Index with_own_yaw = 5;  ///< number of columns

struct RowSettings : YawMotion {
  double tolerance = 0;  ///< m, rad
};

/// A path with rows without yaw.
class PathWithoutYaw final : public ReferenceShape {
 public:
  PathWithoutYaw(const SepticPath& path, const YawMotion& yaw) : path_(path), yaw_(yaw) {
    const Reference first = path.at(path.begin());
    const Reference last = path.at(std::nextafter(path.end(), path.begin()));
    // A path leaves rest along the snap and reaches rest against it.
    const auto direction = [](const Vector3d& v_W, const Vector3d& at_rest_W) {
      const Vector3d& d = v_W.head<2>().norm() > 1e-6 ? v_W : at_rest_W;
      return elementary::atan2(d.y(), d.x());
    };
    leaves_ = direction(first.velocity, first.snap);
    comes_ = direction(last.velocity, -last.snap);
  }

  Reference at(double t) const override {
    Reference wanted = path_.at(t);
    yaw_.turn(t, wanted, 2 * t < path_.begin() + path_.end() ? leaves_ : comes_);
    return wanted;
  }
  double end() const override {
    return yaw_.yaw_rate == 0 ? path_.end() : std::numeric_limits<double>::infinity();
  }

 private:
  SepticPath path_;
  YawMotion yaw_;
  double leaves_, comes_;  ///< headings at rest [rad]
};

std::unique_ptr<ReferenceShape> with_yaw_motion(const std::string& name, SepticPath path,
                                                const YawMotion& yaw, const Values& values,
                                                const Rows& rows) {
  if (rows.cols() != with_own_yaw) return std::make_unique<PathWithoutYaw>(path, yaw);
  for (const char* own : {"yaw", "yaw_rate", "along"}) {
    if (values.count(own) == 0) continue;
    throw InputError("reference '" + name + "': its rows and '" + own +
                     "' both set the yaw. Remove one of them.");
  }
  return std::make_unique<SepticPath>(std::move(path));
}

/// Shift the times to start at the first row and remove jumps of the yaw between -pi and pi.
Rows of_motion(Rows rows) {
  if (rows.rows() > 0) rows.col(0).array() -= rows(0, 0);
  for (Eigen::Index i = 1; i < rows.rows() && rows.cols() == with_own_yaw; ++i) {
    const double step = rows(i, 4) - rows(i - 1, 4);
    rows(i, 4) = rows(i - 1, 4) + std::remainder(step, 2 * M_PI);
  }
  return rows;
}

SepticPath path_of(const Rows& motion, const VectorXd& tolerances) {
  SepticPath through = SepticPath::smoothest(motion, SepticPath::Ends::free);
  const std::vector<SepticPath::Point> points = fitted(motion, tolerances);
  return points.empty() ? through : SepticPath::smoothest(points);
}

struct TakeoffLand : Place {
  double ground, wait, rise, stay, by;
};

}  // namespace

ReferenceInfo waypoints() {
  const Settings<YawMotion> settings = with_yaw<YawMotion>({});
  return {"waypoints", "minimum-snap path through positions at given times", true,
          table_of(settings), [settings](const Values& values, const Rows& rows) {
            YawMotion yaw;
            configure(yaw, settings, values);
            return with_yaw_motion("waypoints",
                                   SepticPath::smoothest(rows, SepticPath::Ends::at_rest), yaw,
                                   values, rows);
          }};
}

ReferenceInfo series() {
  const Settings<RowSettings> settings =
      with_yaw<RowSettings>({{T::number("tolerance", "m", "0",
                                        "error of the rows in position, and in yaw in rad, that "
                                        "the fit assumes in addition to rounding")
                                  .at_least(0),
                              &RowSettings::tolerance}});
  return {"series", "motion fitted to rows of time and position", true, table_of(settings),
          [settings](const Values& values, const Rows& rows) {
            RowSettings s;
            configure(s, settings, values);
            const Rows motion = of_motion(rows);
            const VectorXd tolerances = last_digits(rows).array() + s.tolerance;
            return with_yaw_motion("series", path_of(motion, tolerances), s, values, motion);
          }};
}

ReferenceInfo takeoff_land() {
  const Settings<TakeoffLand> settings = {
      {T::number("x", "m", "0", "position along x"), &TakeoffLand::x},
      {T::number("y", "m", "0", "position along y"), &TakeoffLand::y},
      {T::number("yaw", "rad", "0", "yaw at the start"), &TakeoffLand::yaw},
      {T::number("turn", "rad", "0", "yaw rotation during the hover, from rest to rest"),
       &TakeoffLand::by},
      {T::number("height", "m", "1", "height of the frame in the hover"), &TakeoffLand::height},
      {T::number("ground", "m", "0.0125",
                 "height of the frame on the ground; for a known vehicle, its height at rest"),
       &TakeoffLand::ground},
      {T::number("wait", "s", "1", "waiting time on the ground before take-off").above(0),
       &TakeoffLand::wait},
      {T::number("rise", "s", "4", "duration of the climb, and of the descent").above(0),
       &TakeoffLand::rise},
      {T::number("stay", "s", "10", "duration of the hover").above(0), &TakeoffLand::stay},
  };
  return {"takeoff_land", "take-off, hover and landing", false, table_of(settings),
          [settings](const Values& values, const Rows&) {
            TakeoffLand s{};
            configure(s, settings, values);
            Rows rows(5, 5);
            double t = 0;
            int row = 0;
            const auto be_at = [&](double z, double yaw) {
              rows.row(row++) << t, s.x, s.y, z, yaw;
            };
            be_at(s.ground, s.yaw);
            t += s.wait;
            be_at(s.ground, s.yaw);
            t += s.rise;
            be_at(s.height, s.yaw);
            t += s.stay;
            be_at(s.height, s.yaw + s.by);
            t += s.rise;
            be_at(s.ground, s.yaw + s.by);
            return std::make_unique<SepticPath>(SepticPath::resting(rows));
          }};
}

}  // namespace quadcore::control
