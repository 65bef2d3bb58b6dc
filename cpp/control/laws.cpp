#include "cascade.hpp"
#include "geometric.hpp"
#include "indi.hpp"
#include "lqr.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore::control {

const std::vector<LawInfo>& laws() {
  static const Values as_printed = {{"ki_xy", 0.8}, {"kd_xy", 0.125}, {"ki_z", 0.8},  {"ki_rp", 96},
                                    {"kp_yaw", 96}, {"ki_yaw", 96},   {"kd_yaw", 16}, {"lead", 0}};
  static const Values repaired = {{"ki_xy", 0.8}, {"ki_z", 0.8}, {"ki_rp", 96}, {"lead", 0}};
  static const Values compensated = {
      {"drag", 1}, {"gyroscopic", 1}, {"flat_rates", 1}, {"lead", 0}};
  static const std::vector<LawInfo> all = {
      law<Cascade>("pd", "cascade PD with feedback linearisation, thesis (2.43)-(2.51)",
                   {{"lead", 0}}),
      law<Cascade>("pd_compensated",
                   "the same with drag and gyroscopic torque, thesis (2.52)-(2.57)", compensated),
      law<Cascade>("pid_thesis", "the cascade PID of thesis section 6.2 with the printed gains",
                   as_printed),
      law<Cascade>("pid", "the same with gains that fly", repaired),
      law<Geometric>("geometric", "tracking on SE(3) with what the reference asks for fed forward"),
      law<Indi>("indi",
                "the same by increments of what the rotors exert, from measured accelerations",
                {{"integral", 0}}),
      law<Lqr>("lqr", "a linear regulator around the reference, optimal in hover"),
  };
  return all;
}

const LawInfo& law_info(const std::string& name) {
  std::vector<std::string> names;
  for (const LawInfo& info : laws()) {
    if (info.name == name) return info;
    names.push_back(info.name);
  }
  throw InputError("there is no law '" + name + "'" + did_you_mean(name, names) + "; give one of " +
                   joined(names));
}

}  // namespace quadcore::control
