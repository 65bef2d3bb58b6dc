#include "control/references/septic_path.hpp"
#include "control/references/shapes.hpp"

namespace quadcore::control {
namespace {

using T = TagSpec;

ReferenceInfo through_rows(const char* name, const char* summary, SepticPath::Ends ends) {
  return {name, summary, true, {}, [ends](const Values&, const Rows& rows) {
            return std::make_unique<SepticPath>(SepticPath::smoothest(rows, ends));
          }};
}

struct TakeoffLand : Place {
  double ground, wait, rise, stay;
};

}  // namespace

ReferenceInfo waypoints() {
  return through_rows("waypoints", "the smoothest path (minimum snap) through places at times",
                      SepticPath::Ends::at_rest);
}

ReferenceInfo series() {
  return through_rows("series", "a motion as rows of time and place tell it",
                      SepticPath::Ends::free);
}

ReferenceInfo takeoff_land() {
  const Settings<TakeoffLand> settings = {
      {T::number("x", "m", "0", "where it stands"), &TakeoffLand::x},
      {T::number("y", "m", "0", "where it stands"), &TakeoffLand::y},
      {T::number("yaw", "rad", "0", "which is kept"), &TakeoffLand::yaw},
      {T::number("height", "m", "1", "of the frame in the hover"), &TakeoffLand::height},
      {T::number("ground", "m", "0.0125", "height of the frame where it stands"),
       &TakeoffLand::ground},
      {T::number("wait", "s", "1", "on the ground before").above(0), &TakeoffLand::wait},
      {T::number("rise", "s", "4", "for the way up, and for the way down").above(0),
       &TakeoffLand::rise},
      {T::number("stay", "s", "10", "in the hover").above(0), &TakeoffLand::stay},
  };
  return {"takeoff_land", "up from the ground, a hover, and down again", false, table_of(settings),
          [settings](const Values& values, const Rows&) {
            TakeoffLand s{};
            configure(s, settings, values);
            Rows rows(5, 5);
            double t = 0;
            int row = 0;
            const auto be_at = [&](double z) { rows.row(row++) << t, s.x, s.y, z, s.yaw; };
            be_at(s.ground);
            t += s.wait;
            be_at(s.ground);
            t += s.rise;
            be_at(s.height);
            t += s.stay;
            be_at(s.height);
            t += s.rise;
            be_at(s.ground);
            return std::make_unique<SepticPath>(SepticPath::resting(rows));
          }};
}

}  // namespace quadcore::control
