#include <stdexcept>

#include "expectations.hpp"
#include "fuzz_input.hpp"
#include "fuzz_vehicles.hpp"
#include "grammar.hpp"
#include "quadcore/plugin/error.hpp"

/// \file
/// Sets tags of plugins to odd texts and flies what is accepted for a few steps.

namespace {

using namespace quadcore;

/// A vehicle and the names of all tags that its plugins have.
struct Tagged {
  FuzzVehicle vehicle;
  std::vector<std::string> names;

  explicit Tagged(const FuzzVehicle& of) : vehicle(of) {
    const auto simulation = vehicle.simulate();
    for (const LoadedPlugin& plugin : simulation->plugins()) {
      for (const Parameter& parameter : plugin.parameters.all()) {
        names.push_back(plugin.name + "." + parameter.spec.name);
      }
    }
  }
};

std::vector<Tagged> all_tagged() {
  std::vector<Tagged> all;
  for (const FuzzVehicle& vehicle : fuzz_vehicles()) all.emplace_back(vehicle);
  return all;
}

std::string odd_value(FuzzInput& input) {
  switch (input.below(8)) {
    case 0:
      return input.any(words());
    case 1:
      return input.text(24);
    case 2:
    case 3: {
      std::string row = input.any(numbers());
      for (std::size_t n = input.below(9); n > 0; --n) row += " " + input.any(numbers());
      return row;
    }
    default:
      return input.any(numbers());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<Tagged> all = all_tagged();
  const TimeLimit limit;
  FuzzInput input(data, size);
  const Tagged& tagged = input.any(all);
  std::map<std::string, std::string> parameters;
  for (std::size_t n = 1 + input.below(3); n > 0; --n) {
    const std::string name = input.below(32) == 0 ? input.text(16) : input.any(tagged.names);
    parameters[name] = odd_value(input);
  }
  try {
    const auto simulation = tagged.vehicle.simulate(parameters);
    try {
      simulation->step(3);
    } catch (const FlightError& error) {
      check_one_line(error.what());
    }
    simulation->reset();
  } catch (const InputError& error) {
    check_one_line(error.what());
  }
  limit.check();
  return 0;
}
