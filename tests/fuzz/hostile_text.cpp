#include "hostile_text.hpp"

#include <cctype>
#include <stdexcept>

#include "expectations.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/plugin/world.hpp"
#include "quadcore/simulation.hpp"

namespace {

using namespace quadcore;

constexpr const char* file = "hostile.xml";
/// The time of a step grows with the cube of the rotors; many of them are slow, not hostile.
constexpr std::size_t most_rotors = 12;

constexpr const char* toy = R"(<robot name="toy">
  <link name="frame">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <link name="wheel">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <joint name="axle" type="continuous"><parent link="frame"/><child link="wheel"/></joint>
</robot>)";

void check_message(const std::string& message, bool with_place) {
  check_one_line(message);
  const std::string place = std::string(file) + ":";
  if (with_place && (message.rfind(place, 0) != 0 || !std::isdigit(message[place.size()]))) {
    throw std::logic_error("no FILE:LINE before " + message);
  }
}

/// A flight may fail with a reason; a reset then takes it back to its start.
void fly(const Model& model, const World& world) {
  if (model.joints.size() > most_rotors) return;
  for (const EngineInfo& engine : engines()) {
    try {
      SimulationOptions options;
      options.engine = engine.name;
      Simulation simulation(model, world, options);
      const Vector3d start = simulation.state().position;
      try {
        simulation.step(3);
        simulation.wrenches();
      } catch (const FlightError& error) {
        check_message(error.what(), false);
      }
      simulation.reset();
      if (simulation.state().position != start) throw std::logic_error("the reset moved it");
    } catch (const InputError& error) {
      check_message(error.what(), true);
    }
  }
}

template <typename Read, typename Use>
void check(Read read, const Document& document, Use use) {
  try {
    use(read(document));
  } catch (const InputError& error) {
    check_message(error.what(), true);
  }
}

}  // namespace

void check_hostile_text(const std::string& text) {
  const TimeLimit limit;
  const Document document{file, text};
  World ground;
  ground.ground_plane = true;
  check([](const Document& d) { return read_model(d); }, document,
        [&](const Model& model) {
          fly(model, ground);
          fly(model, World{});
        });
  check([](const Document& d) { return read_world(d); }, document,
        [](const World& world) { fly(read_model({"toy", toy}), world); });
  limit.check();
}
