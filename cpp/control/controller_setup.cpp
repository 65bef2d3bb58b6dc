#include "controller_setup.hpp"

#include <utility>

#include "quadcore/control/modelled_vehicle_file.hpp"
#include "quadcore/control/rows_file.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"
#include "tags.hpp"

namespace quadcore::control {
namespace {

using T = TagSpec;
using Tables = std::vector<std::pair<std::string, std::vector<TagSpec>>>;  ///< by name of the owner

std::vector<std::string> names_of(const Tables& tables) {
  std::vector<std::string> names;
  for (const auto& [who, table] : tables) names.push_back(who);
  return names;
}

const Tables& controller_tables() {
  static const Tables tables = [] {
    Tables all;
    for (const ControllerInfo& info : list_controllers())
      all.emplace_back(info.name, Controller::table(info.name));
    return all;
  }();
  return tables;
}

const Tables& reference_tables() {
  static const Tables tables = [] {
    Tables all;
    for (const ReferenceInfo& info : references()) {
      all.emplace_back(info.name, info.table);
    }
    return all;
  }();
  return tables;
}

std::vector<TagSpec> with(std::vector<TagSpec> tags, const std::vector<TagSpec>& more) {
  tags.insert(tags.end(), more.begin(), more.end());
  return tags;
}

std::vector<TagSpec> timing_tags() {
  std::vector<TagSpec> tags;
  for (const TagSpec& spec : timing_table()) {
    tags.push_back(spec.or_absent("the value of the gains file, else " + spec.fallback));
  }
  return tags;
}

/// Return the gains of the tags, completed with those of the gains file.
Gains choose_gains(const Parameters& tags) {
  Gains gains;
  if (tags.has("gains")) {
    gains = read_gains(tags.file("gains"));
    if (tags.has("law") && tags.choice("law") != gains.law) {
      throw InputError("<law> is " + tags.choice("law") + ", but the gains file " +
                       tags.text("gains") + " is for " + gains.law + ". Remove <law>.");
    }
  } else if (tags.has("law")) {
    gains.law = tags.choice("law");
  } else {
    throw InputError("no controller is named. Write <law> or <gains>.");
  }
  if (tags.has("rate")) gains.rate = tags.number("rate");
  if (tags.has("delay")) gains.delay = tags.number("delay");
  gains.values = complete(values_of(tags, merge_tags(controller_tables())), gains.values);
  return gains;
}

}  // namespace

const std::vector<TagSpec>& ControllerSetup::tags() {
  static const std::vector<TagSpec> all = with(
      {T::choice("law", names_of(controller_tables()), "the controller")
           .or_absent("the controller of the gains file"),
       T::file("gains", "a gains file; other tags override it")
           .or_absent("default values of all parameters"),
       T::file("belief",
               "URDF of the vehicle that the controller models; only its plugins that exert forces "
               "are used")
           .or_absent("the simulated vehicle"),
       T::numbers("spins", "", "", "direction of rotation of each rotor about its axis, 1 or -1")
           .or_absent("alternating around the vehicle"),
       T::choice("twistFrame", {"world", "body"}, "axes of the odometry's linear velocity")
           .agreed()},
      with(timing_tags(), merge_tags(controller_tables())));
  return all;
}

ControllerSetup::ControllerSetup(const Parameters& parameters)
    : gains(choose_gains(parameters)),
      spins(parameters.numbers("spins")),
      model_path(parameters.file("belief")),
      in_body(parameters.choice("twistFrame") == "body") {}

VehicleDescription ControllerSetup::describe_model(const VehicleDescription& flown) const {
  return model_path.empty() ? flown : read_modelled_vehicle(model_path, flown);
}

const std::vector<TagSpec>& reference_tags() {
  static const std::vector<TagSpec> all = [] {
    std::vector<std::string> with_rows;
    for (const ReferenceInfo& info : references()) {
      if (info.takes_rows) with_rows.push_back(info.name);
    }
    return with({T::choice("shape", names_of(reference_tables()), "shape of the reference"),
                 T::file("rows", "for " + joined(with_rows) +
                                     ": file of times and positions, .csv or .yaml")
                     .or_absent("none; for the other shapes")},
                merge_tags(reference_tables()));
  }();
  return all;
}

std::unique_ptr<ReferenceShape> reference_of(const Parameters& parameters, const Model& model) {
  const std::string& name = parameters.choice("shape");
  const Values values = values_of(parameters, merge_tags(reference_tables()));
  return make_reference(name, on_vehicle(name, values, model),
                        parameters.has("rows") ? read_rows(parameters.file("rows")) : Rows());
}

}  // namespace quadcore::control
