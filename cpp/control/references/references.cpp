#include "control/references/shapes.hpp"
#include "quadcore/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore::control {

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
  throw InputError("there is no reference '" + name + "'" + did_you_mean(name, names) +
                   "; give one of " + joined(names));
}

std::unique_ptr<ReferenceShape> make_reference(const std::string& name, const Values& values,
                                               const Rows& rows) {
  const ReferenceInfo& info = reference_info(name);
  const std::string who = "reference '" + name + "'";
  check_values(who, info.table, values);
  if (info.takes_rows != (rows.size() > 0)) {
    throw InputError(who + (info.takes_rows ? " needs rows of t, x, y, z[, yaw]; give them"
                                            : " takes no rows; leave them out"));
  }
  return info.make(values, rows);
}

}  // namespace quadcore::control
