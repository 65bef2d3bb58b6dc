#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "lowest_point.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"
#include "references/shapes.hpp"

namespace quadcore::control {
namespace {

std::uint64_t next_serial() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

ReferenceShape::ReferenceShape() : serial_(next_serial()) {}

const std::vector<ReferenceInfo>& references() {
  static const std::vector<ReferenceInfo> all = {
      hover(), step(), ramp(), spiral(), circle(), eight(), waypoints(), series(), takeoff_land()};
  return all;
}

const ReferenceInfo& reference_info(const std::string& name) {
  std::vector<std::string> names;
  for (const ReferenceInfo& info : references()) {
    if (info.name == name) return info;
    names.push_back(info.name);
  }
  throw InputError("reference '" + name + "' does not exist." + suggest(name, names) +
                   " Choose one of " + joined(names) + ".");
}

Values on_vehicle(const std::string& name, Values values, const Model& model) {
  const std::vector<TagSpec>& table = reference_info(name).table;
  const auto is_ground = [](const TagSpec& spec) { return spec.name == "ground"; };
  if (std::none_of(table.begin(), table.end(), is_ground)) return values;
  double lowest = std::numeric_limits<double>::infinity();
  const std::vector<Eigen::Isometry3d> poses = link_poses(model);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    for (const Collision& shape : model.links[i].collisions) {
      const Matrix3d R_WS = poses[i].linear() * shape.pose.rotation().toRotationMatrix();
      lowest = std::min(lowest, (poses[i] * shape.pose.xyz).z() - reach_down(shape, R_WS));
    }
  }
  if (std::isfinite(lowest)) values.insert({"ground", -lowest});
  return values;
}

std::unique_ptr<ReferenceShape> make_reference(const std::string& name, const Values& values,
                                               const Rows& rows) {
  const ReferenceInfo& info = reference_info(name);
  const std::string who = "reference '" + name + "'";
  check_values(who, info.table, values);
  if (info.takes_rows != (rows.size() > 0)) {
    throw InputError(who + (info.takes_rows ? " requires rows of t, x, y, z[, yaw]. Give them."
                                            : " accepts no rows. Remove them."));
  }
  return info.make(values, rows);
}

}  // namespace quadcore::control
