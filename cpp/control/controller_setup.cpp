#include "controller_setup.hpp"

#include <utility>

#include "quadcore/control/rows_file.hpp"
#include "quadcore/control/second_vehicle.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"
#include "tags.hpp"

namespace quadcore::control {
namespace {

using T = TagSpec;
using Tables = std::vector<std::pair<std::string, std::vector<TagSpec>>>;  ///< by who has them

std::vector<std::string> names_of(const Tables& tables) {
  std::vector<std::string> names;
  for (const auto& [who, table] : tables) names.push_back(who);
  return names;
}

const Tables& of_laws() {
  static const Tables tables = [] {
    Tables all;
    for (const LawInfo& law : laws()) all.emplace_back(law.name, Controller::table(law.name));
    return all;
  }();
  return tables;
}

const Tables& of_references() {
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
    tags.push_back(spec.or_absent("that of the gains, or " + spec.fallback));
  }
  return tags;
}

/// What the tags ask for; what they leave open is that of the gains file.
Gains chosen(const Parameters& tags) {
  Gains gains;
  if (tags.has("gains")) {
    gains = read_gains(tags.file("gains"));
    if (tags.has("law") && tags.choice("law") != gains.law) {
      throw InputError("<law> is " + tags.choice("law") + ", but the gains of " +
                       tags.text("gains") + " are those of " + gains.law + "; leave <law> out");
    }
  } else if (tags.has("law")) {
    gains.law = tags.choice("law");
  } else {
    throw InputError("no law is named; write <law> or <gains>");
  }
  if (tags.has("rate")) gains.rate = tags.number("rate");
  if (tags.has("delay")) gains.delay = tags.number("delay");
  gains.values = completed(values_of(tags, tags_of(of_laws())), gains.values);
  return gains;
}

}  // namespace

const std::vector<TagSpec>& ControllerSetup::tags() {
  static const std::vector<TagSpec> all = with(
      {T::choice("law", names_of(of_laws()), "the law that is flown")
           .or_absent("that of the gains"),
       T::file("gains", "a gains file; what other tags set wins")
           .or_absent("every parameter at its default"),
       T::file("belief",
               "URDF of the vehicle that the law believes to fly; of its plugins only "
               "what exerts forces is asked")
           .or_absent("what flies"),
       T::numbers("spins", "", "", "1 or -1: the sense in which each rotor turns about its axis")
           .or_absent("neighbours around the vehicle turn against each other"),
       T::choice("twistFrame", {"world", "body"}, "axes of the odometry's linear velocity")
           .agreed()},
      with(timing_tags(), tags_of(of_laws())));
  return all;
}

ControllerSetup::ControllerSetup(const Parameters& parameters)
    : gains(chosen(parameters)),
      spins(parameters.numbers("spins")),
      belief(parameters.file("belief")),
      in_body(parameters.choice("twistFrame") == "body") {}

VehicleDescription ControllerSetup::believed(const VehicleDescription& flown) const {
  return belief.empty() ? flown : second_vehicle(belief, flown);
}

const std::vector<TagSpec>& reference_tags() {
  static const std::vector<TagSpec> all = [] {
    std::vector<std::string> of_rows;
    for (const ReferenceInfo& info : references()) {
      if (info.takes_rows) of_rows.push_back(info.name);
    }
    return with({T::choice("shape", names_of(of_references()), "where the vehicle is to be"),
                 T::file("rows", "of " + joined(of_rows) + ": times and places, .csv or .yaml")
                     .or_absent("none, for the other shapes")},
                tags_of(of_references()));
  }();
  return all;
}

std::unique_ptr<ReferenceShape> reference_of(const Parameters& parameters, const Model& model) {
  const std::string& name = parameters.choice("shape");
  const Values values = values_of(parameters, tags_of(of_references()));
  return make_reference(name, on_vehicle(name, values, model),
                        parameters.has("rows") ? read_rows(parameters.file("rows")) : Rows());
}

}  // namespace quadcore::control
