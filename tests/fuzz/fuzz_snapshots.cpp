#include <cmath>
#include <limits>
#include <stdexcept>

#include "expectations.hpp"
#include "fuzz_input.hpp"
#include "fuzz_vehicles.hpp"
#include "quadcore/plugin/error.hpp"

/// \file
/// Damages snapshots of vehicles whose plugins remember much, restores them and flies on. Expected
/// is a flight, or one line about why there is none; then the undamaged snapshot flies as before.

namespace {

using namespace quadcore;

constexpr int steps = 3;

/// A simulation, a snapshot in the midst of its flight, and where that leads.
struct Flown {
  std::unique_ptr<Simulation> simulation;
  Snapshot whole;
  Vector3d position;

  explicit Flown(const FuzzVehicle& vehicle) : simulation(vehicle.simulate()) {
    simulation->step(20);
    whole = simulation->snapshot();
    // As it comes from a file: equal to the simulation's own, but another object.
    whole.taken_from = std::make_shared<Fingerprint>(*whole.taken_from);
    simulation->step(steps);
    position = simulation->state().position;
  }

  void check_undamaged() {
    simulation->restore(whole);
    simulation->step(steps);
    if (simulation->state().position != position) throw std::logic_error("it flies otherwise");
  }
};

std::vector<Flown> all_flown() {
  std::vector<Flown> all;
  for (const FuzzVehicle& vehicle : fuzz_vehicles()) all.emplace_back(vehicle);
  return all;
}

/// A number at which counts, times and indices break, or any.
double odd_number(FuzzInput& input, double present) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  static const std::vector<double> odd = {
      0,      -0.0,    1,      -1,       0.5,       -0.5,        2,      3,      4,
      10,     1e3,     1e6,    1e9,      1e15,      1e18,        1e19,   1e20,   1e100,
      1e300,  -1e300,  1e-9,   1e-300,   0x1p31,    0x1p32,      0x1p52, 0x1p53, 0x1p54,
      0x1p63, -0x1p63, 0x1p64, infinity, -infinity, std::nan("")};
  const std::size_t choice = input.below(odd.size() + 6);
  if (choice < odd.size()) return odd[choice];
  switch (choice - odd.size()) {
    case 0:
      return present + 1;
    case 1:
      return present - 1;
    case 2:
      return -present;
    case 3:
      return present * 1e9;
    default:
      return input.take<double>();
  }
}

void damage(double& number, FuzzInput& input) { number = odd_number(input, number); }

void damage_any(double* numbers, std::size_t count, FuzzInput& input) {
  if (count > 0) damage(numbers[input.below(count)], input);
}

void damage(Snapshot& snapshot, FuzzInput& input) {
  switch (input.below(16)) {
    case 0:
      return damage(snapshot.start_time, input);
    case 1:
      snapshot.steps = input.take<std::int64_t>();
      return;
    case 2:
      snapshot.seed = input.take<std::uint64_t>();
      return;
    case 3:
      snapshot.engine.resize(input.below(2 * snapshot.engine.size() + 2));
      return;
    case 4:
      snapshot.plugin_state.conservativeResize(
          static_cast<Eigen::Index>(input.below(2 * snapshot.engine.size() + 2)));
      return;
    case 5:
      snapshot.messages.resize(input.below(2 * snapshot.messages.size() + 2));
      return;
    case 6:
      if (!snapshot.messages.empty()) {
        snapshot.messages[input.below(snapshot.messages.size())].values.resize(input.below(40));
      }
      return;
    case 7:
      snapshot.failure = input.text(20);
      return;
    case 8:
    case 9:
      return damage_any(snapshot.engine.data(), snapshot.engine.size(), input);
    case 10:
    case 11: {
      if (snapshot.messages.empty()) return;
      Message& message = snapshot.messages[input.below(snapshot.messages.size())];
      const std::size_t choice = input.below(4);
      if (choice == 0) return damage(message.stamp, input);
      if (choice == 1) return damage(message.count, input);
      return damage_any(message.values.data(), message.values.size(), input);
    }
    default:
      return damage_any(snapshot.plugin_state.data(),
                        static_cast<std::size_t>(snapshot.plugin_state.size()), input);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static std::vector<Flown> all = all_flown();
  const TimeLimit limit;
  FuzzInput input(data, size);
  Flown& flown = all[input.below(all.size())];
  Snapshot damaged = flown.whole;
  for (std::size_t n = 1 + input.below(3); n > 0; --n) damage(damaged, input);
  try {
    flown.simulation->restore(damaged);
    flown.simulation->step(steps);
  } catch (const InputError& error) {
    check_one_line(error.what());
  } catch (const FlightError& error) {
    check_one_line(error.what());
  }
  if (input.below(16) == 0) flown.check_undamaged();
  limit.check();
  return 0;
}
