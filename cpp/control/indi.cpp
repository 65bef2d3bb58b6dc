#include "indi.hpp"

#include <string>

#include "quadcore/plugin/elementary.hpp"

namespace quadcore::control {
namespace {

/// Force, roll and pitch are measured here instead of modelled.
Settings<Indi::Gains> of_what_is_measured(Settings<Indi::Gains> settings) {
  for (Setting<Indi::Gains>& setting : settings) {
    std::string& meaning = setting.spec.meaning;
    if (setting.spec.name == "drag") {
      meaning = "compensates the modelled torque about z and the flat state; the rest is measured";
    } else if (setting.spec.name == "gyroscopic") {
      meaning = "compensates the rotors' gyroscopic torque about z; the other axes are measured";
    }
  }
  return settings;
}

}  // namespace

const Settings<Indi::Gains>& Indi::settings() {
  static const Settings<Gains> all = of_what_is_measured(with_tracking<Gains>(
      {{TagSpec::number(
            "filter", "rad/s", "40",
            "cut-off frequency of the filters on the accelerations and the rotors' wrench")
            .above(0),
        &Gains::filter}}));
  return all;
}

Demand Indi::demand(const ControllerInput& input, double* memory) const {
  const double share = filter_share(input.period);
  return tracking_.demand(input, [&](const TrackingFormulas<double>& formulas) {
    return demand_incrementally(formulas, share, memory_of<IndiMemory>(memory));
  });
}

double Indi::filter_share(double period) const { return 1 - elementary::exp(-filter_ * period); }

std::shared_ptr<const LaneWrenchController> Indi::in_lanes(double period) const {
  const IndiNumbers<double> numbers{tracking_.numbers(), filter_share(period)};
  return std::make_shared<LaneWrenchController>(
      LaneWrenchController{ControllerKind::indi, tracking_.switches(), list_numbers(numbers)});
}

}  // namespace quadcore::control
