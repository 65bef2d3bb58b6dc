#include "settings.hpp"

#include "flight_log.hpp"
#include "private_parameters.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::node {
namespace {

ClockRole parse_clock_role(const std::string& text) {
  if (text == "auto") return ClockRole::automatic;
  if (text == "lead") return ClockRole::lead;
  if (text == "follow") return ClockRole::follow;
  refuse_parameter("clock", "auto, lead or follow");
}

}  // namespace

Settings read_settings(const ros::NodeHandle& nh) {
  PrivateParameters p;
  Settings s;
  s.plant = read_plant(p);
  s.log = resolve_path(s.plant.folder, p.text("log", ""));
  if (!s.log.empty() && !is_log(s.log)) {
    refuse_parameter("log", "a file that ends in .csv, .mat or .bag, not " + s.log);
  }
  s.log_topics = p.words("log_topics");
  if (s.log.empty() && !s.log_topics.empty()) {
    throw InputError("parameter ~log_topics: has no effect without a log. Set ~log.");
  }
  s.verbose = p.flag("verbose", false);
  s.rotor_tf = p.flag("rotor_tf", false);
  s.clock = parse_clock_role(p.text("clock", "auto"));
  s.real_time_factor = p.non_negative("real_time_factor", "; 0 is as fast as possible");
  s.flight.paused = p.flag("paused", false);
  s.flight.lockstep = p.flag("lockstep", false);
  s.flight.lockstep_timeout = p.positive("lockstep_timeout").value_or(s.flight.lockstep_timeout);
  s.flight.command_timeout =
      p.non_negative("command_timeout", "; 0 is never").value_or(s.flight.command_timeout);
  s.flight.answered = p.text("lockstep_topic", s.flight.answered);
  p.check_all_known();
  read_description(nh, s.plant);
  return s;
}

}  // namespace quadcore::node
