#include "settings.hpp"

#include <cmath>
#include <cstdlib>

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

/// Parses NAME=ANGLE ...
std::map<std::string, double> parse_angles(const std::string& parameter,
                                           const std::vector<std::string>& words) {
  std::map<std::string, double> angles;
  for (const std::string& word : words) {
    const auto equals = word.find('=');
    char* end = nullptr;
    const double angle =
        equals == std::string::npos ? NAN : std::strtod(word.c_str() + equals + 1, &end);
    if (!std::isfinite(angle) || *end != '\0' || end == word.c_str() + equals + 1) {
      refuse_parameter(parameter, "JOINT=ANGLE ..., in rad, not '" + word + "'");
    }
    angles[word.substr(0, equals)] = angle;
  }
  return angles;
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
  s.log_every = static_cast<std::int64_t>(p.whole("log_every", 1, 1, 1000000));
  s.joint_angles = parse_angles("joints", p.words("joints"));
  s.verbose = p.flag("verbose", false);
  s.rotor_tf = p.flag("rotor_tf", false);
  s.clock = parse_clock_role(p.text("clock", "auto"));
  s.clock_rate = p.non_negative("pub_clock_frequency", "; 0 is after each step").value_or(0);
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
