#include "cascade.hpp"
#include "firmware/crazyflie_pid.hpp"
#include "firmware/mellinger.hpp"
#include "firmware/px4.hpp"
#include "geometric.hpp"
#include "indi.hpp"
#include "lqr.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore::control {

const std::vector<ControllerInfo>& list_controllers() {
  static const Values as_printed = {{"ki_xy", 0.8}, {"kd_xy", 0.125}, {"ki_z", 0.8},  {"ki_rp", 96},
                                    {"kp_yaw", 96}, {"ki_yaw", 96},   {"kd_yaw", 16}, {"lead", 0}};
  static const Values repaired = {{"ki_xy", 0.8}, {"ki_z", 0.8}, {"ki_rp", 96}, {"lead", 0}};
  static const Values compensated = {
      {"drag", 1}, {"gyroscopic", 1}, {"flat_rates", 1}, {"lead", 0}};
  static const std::vector<ControllerInfo> all = {
      make_info<Cascade>("pd",
                         "cascaded PD controller with feedback linearisation, thesis (2.43)-(2.51)",
                         {{"lead", 0}}),
      make_info<Cascade>("pd_compensated",
                         "pd with compensation of drag and gyroscopic torque, thesis (2.52)-(2.57)",
                         compensated),
      make_info<Cascade>("pid_thesis",
                         "cascaded PID controller of thesis section 6.2 with the printed gains",
                         as_printed),
      make_info<Cascade>("pid", "pid_thesis with stable gains", repaired),
      make_info<Geometric>(
          "geometric", "geometric tracking controller on SE(3) with feed-forward of the reference"),
      make_info<Indi>(
          "indi",
          "incremental nonlinear dynamic inversion (INDI) with measured accelerations, on SE(3)",
          {{"integral", 0}}),
      make_info<Lqr>("lqr",
                     "linear-quadratic regulator (LQR) around the reference, optimal in hover"),
      make_info<CrazyfliePid>(
          "crazyflie_pid", "PID cascade of the Crazyflie firmware with its gains", {{"lead", 0}}),
      make_info<Mellinger>("mellinger",
                           "Mellinger's controller as in the Crazyflie firmware with its gains",
                           {{"lead", 0}}),
      make_info<Px4>("px4", "multicopter cascade of PX4 with its gains", {{"lead", 0}}),
  };
  return all;
}

const ControllerInfo& find_controller(const std::string& name) {
  std::vector<std::string> names;
  for (const ControllerInfo& info : list_controllers()) {
    if (info.name == name) return info;
    names.push_back(info.name);
  }
  throw InputError("controller '" + name + "' does not exist." + suggest(name, names) +
                   " Choose one of " + joined(names) + ".");
}

}  // namespace quadcore::control
